"""Hostile NPZ: archives that unpack without end or lie about it, and arrays that would run code."""

import io
import pickle  # noqa: TID251  (to show that it is refused)
import struct
import zipfile
import zlib

import numpy as np

from tests.hostile.specimen import checksum, hostile, motion, zeros_deflated

FORM = "NPZ"


class Trap:
    """Write a file when unpickled."""

    def __init__(self, path):
        self.path = path

    def __reduce__(self):
        return open, (str(self.path), "w")


def array_bytes(values) -> bytes:
    stream = io.BytesIO()
    np.lib.format.write_array(stream, np.asarray(values))
    return stream.getvalue()


def array_with_header(header: str, content: bytes = b"") -> bytes:
    """Write an array whose header says what one likes."""
    text = header.encode("latin1") + b"\n"
    return b"\x93NUMPY\x02\x00" + struct.pack("<I", len(text)) + text + content


def archive(members: dict[str, bytes], *, method: int = zipfile.ZIP_STORED) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", method) as file:
        for name, content in members.items():
            file.writestr(name, content)
    return stream.getvalue()


def with_column(content: bytes, *, name: str = "q_1.npy", method: int = zipfile.ZIP_STORED) -> bytes:
    """Put one hostile member among those of a sound log."""
    sound = {f"{column}.npy": array_bytes(values) for column, values in motion().items()}
    return archive(sound | {name: content}, method=method)


def declared(shape: str, dtype: str = "<f8") -> bytes:
    return array_with_header(f"{{'descr': '{dtype}', 'fortran_order': False, 'shape': {shape}, }}", bytes(64))


@hostile(FORM)
def a_pickled_object(_place):
    stream = io.BytesIO()
    np.savez(stream, time=np.arange(5.0), q_1=np.array([{"a": 1}], dtype=object))
    return stream.getvalue()


@hostile(FORM)
def a_pickle_that_writes_a_file(place):
    head = array_with_header("{'descr': '|O', 'fortran_order': False, 'shape': (1,), }")
    return with_column(head + pickle.dumps(Trap(place.folder / "written")))


@hostile(FORM)
def a_pickle_in_place_of_an_array(place):
    return with_column(pickle.dumps(Trap(place.folder / "written")))


@hostile(FORM)
def a_trillion_values_declared(_place):
    return with_column(declared("(1000000000000,)"))


@hostile(FORM)
def a_negative_shape(_place):
    return with_column(declared("(-5,)"))


@hostile(FORM)
def a_shape_whose_product_overflows(_place):
    return with_column(declared("(4611686018427387904, 4)"))


@hostile(FORM)
def an_element_of_a_gigabyte(_place):
    return with_column(declared("(1,)", "|V1073741824"))


@hostile(FORM)
def a_header_of_five_megabytes(_place):
    return with_column(array_with_header("{" + " " * 5_000_000 + "}"))


@hostile(FORM)
def a_header_nested_without_end(_place):
    return with_column(array_with_header("(" * 9000))


@hostile(FORM)
def a_header_that_is_code(_place):
    return with_column(array_with_header("{'descr': __import__('os').system('true'), 'shape': (1,)}"))


@hostile(FORM)
def records_in_place_of_numbers(_place):
    return with_column(array_bytes(np.zeros(1200, dtype=[("a", "f8")])))


def packed_zeros(size: int, dtype: str, shape: tuple[int, ...]) -> bytes:
    stream = io.BytesIO()
    np.lib.format.write_array_header_2_0(stream, {"descr": dtype, "fortran_order": False, "shape": shape})
    head = stream.getvalue()
    packed = zeros_deflated(size, head=head, bare=True)
    return one_member(packed, crc=checksum(zlib.crc32, size, head), size=len(head) + size)


def one_member(packed: bytes, *, crc: int, size: int) -> bytes:
    """Write an archive of one member that has these packed bytes, and is said to have that sum and size."""
    empty = archive({"q.npy": b""}, method=zipfile.ZIP_DEFLATED)
    directory, end = empty.index(b"PK\x01\x02"), empty.index(b"PK\x05\x06")
    head, entry, tail = (
        bytearray(part) for part in (empty[: empty.index(b"q.npy") + 5], empty[directory:end], empty[end:])
    )
    head[14:26] = entry[16:28] = struct.pack("<III", crc, len(packed), size)
    tail[16:20] = struct.pack("<I", len(head) + len(packed))
    return bytes(head) + packed + bytes(entry) + bytes(tail)


@hostile(FORM)
def a_bomb_of_half_a_gigabyte(_place):
    return packed_zeros(1 << 29, "<f8", (1 << 26,))


@hostile(FORM)
def a_bomb_that_keeps_within_the_count_of_values(_place):
    return packed_zeros(304 << 20, "<f8", (38 << 20,))


@hostile(FORM)
def a_bomb_of_single_bytes(_place):
    return packed_zeros(304 << 20, "|i1", (304 << 20,))


@hostile(FORM)
def a_bomb_by_lzma(_place):
    return archive({"q.npy": declared("(10000000,)") + bytes(80_000_000)}, method=zipfile.ZIP_LZMA)


@hostile(FORM)
def a_directory_that_lies_about_sizes(_place):
    content = bytearray(with_column(array_bytes(np.zeros(10))))
    at = content.rfind(b"PK\x01\x02")
    content[at + 24 : at + 28] = struct.pack("<I", 2**31)
    return bytes(content)


@hostile(FORM)
def members_that_lie_over_each_other(_place):
    """Every entry of the directory points at one member, as David Fifield's bomb does (WOOT 2019)."""
    whole = archive({"a.npy": declared("(30000000,)") + bytes(1000)})
    directory = whole[whole.index(b"PK\x01\x02") : whole.index(b"PK\x05\x06")]
    many = b"".join(directory.replace(b"a.npy", b"%c.npy" % letter) for letter in range(ord("a"), ord("z")))
    end = struct.pack("<4s4H2IH", b"PK\x05\x06", 0, 0, 25, 25, len(many), whole.index(b"PK\x01\x02"), 0)
    return whole[: whole.index(b"PK\x01\x02")] + many + end


@hostile(FORM)
def sixty_thousand_members(_place):
    return archive({f"{number}.npy": b"" for number in range(60_000)})


@hostile(FORM)
def an_encrypted_member(_place):
    content = bytearray(with_column(array_bytes(np.zeros(10))))
    for signature, flags in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        at = content.rfind(signature)
        content[at + flags] |= 1
    return bytes(content)


@hostile(FORM)
def a_packing_that_nobody_knows(_place):
    content = bytearray(with_column(array_bytes(np.zeros(10))))
    at = content.rfind(b"PK\x01\x02")
    content[at + 10 : at + 12] = struct.pack("<H", 99)
    return bytes(content)


@hostile(FORM)
def names_that_climb_out_of_the_folder(_place):
    return archive({"../../../../etc/cron.d/x.npy": array_bytes(np.zeros(1200))})


@hostile(FORM)
def a_symbolic_link(_place):
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as file:
        link = zipfile.ZipInfo("q_1.npy")
        link.external_attr = 0o120777 << 16
        file.writestr(link, "/etc/passwd")
    return stream.getvalue()


@hostile(FORM)
def no_directory(_place):
    return with_column(array_bytes(np.zeros(1200)))[:5000]


@hostile(FORM)
def a_directory_far_too_long(_place):
    whole = with_column(array_bytes(np.zeros(10)))
    at = whole.rfind(b"PK\x05\x06")
    return whole[: at + 12] + struct.pack("<I", 2**31) + whole[at + 16 :]


@hostile(FORM)
def a_member_whose_bytes_are_a_bomb(_place):
    """The directory says ten bytes; the packed stream holds half a gigabyte."""
    packed = zeros_deflated(1 << 29, bare=True)
    return one_member(packed, crc=zlib.crc32(b"x" * 10), size=10)
