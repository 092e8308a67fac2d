"""Spoil bytes: blindly, at the numbers that formats are made of, and behind their packing.

A packed file that is spoilt blindly only shows that its checksum works; hence archives and compressed parts
are unpacked, spoilt within, and packed again.
"""

import io
import struct
import zipfile
import zlib
from collections.abc import Callable
from random import Random

NUMBERS = (
    0, 1, 2, 7, 8, 0x7F, 0x80, 0xFF, 0x7FFF, 0x8000, 0xFFFF, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF,
    2**63 - 1, 2**63, 2**64 - 1,
)  # fmt: skip  # a table
WIDTHS = {1: "B", 2: "H", 4: "I", 8: "Q"}
WORDS = (
    b"nan", b"inf", b"-", b"1e999", b"1e-400", b"\n", b"\r", b'"', b"''", b",", b";", b"\t", b"#", b"\x00",
    b"\xff", b"\xe2\x80", b"q_1", b"time", b"tau_1", b"qd_1", b"q_2", b"0x1p3", b"(", b"{'descr': '|O'",
    b"'shape': (-1,)", b"'<f8'", b"'<U9'", b"PK\x01\x02", b"PK\x05\x06", b"PAR1", b"\x89HDF", b"MATLAB 7.3",
)  # fmt: skip  # a table
SIGNATURES = (b"TREE", b"HEAP", b"SNOD", b"OHDR", b"FRHP", b"FADB", b"BTHD")
"""Of the parts of an HDF5 file."""
HEADER_MAT5 = 128
COMPRESSED = 15

Mutation = Callable[[bytearray, Random], None]


def _flip(data: bytearray, random: Random) -> None:
    for _ in range(random.choice((1, 1, 2, 5))):
        data[random.randrange(len(data))] ^= 1 << random.randrange(8)


def _number(data: bytearray, random: Random) -> None:
    width = random.choice(tuple(WIDTHS))
    at = random.randrange(max(len(data) - width, 1))
    order = random.choice("<>")
    data[at : at + width] = struct.pack(order + WIDTHS[width], random.choice(NUMBERS) % 256**width)


def _nudge(data: bytearray, random: Random) -> None:
    at = random.randrange(len(data))
    data[at] = (data[at] + random.choice((-2, -1, 1, 2))) % 256


def _cut(data: bytearray, random: Random) -> None:
    del data[random.randrange(1, len(data) + 1) :]


def _remove(data: bytearray, random: Random) -> None:
    at = random.randrange(len(data))
    del data[at : at + random.randrange(1, 200)]


def _repeat(data: bytearray, random: Random) -> None:
    begin = random.randrange(len(data))
    piece = data[begin : begin + random.randrange(1, 400)]
    at = random.randrange(len(data))
    data[at:at] = piece * random.choice((1, 1, 3, 50))


def _overwrite(data: bytearray, random: Random) -> None:
    at = random.randrange(len(data))
    noise = random.randbytes(random.choice((4, 16, 200)))
    data[at : at + len(noise)] = noise


def _word(data: bytearray, random: Random) -> None:
    at = random.randrange(len(data))
    word = random.choice(WORDS)
    data[at : at + random.choice((0, len(word)))] = word


MUTATIONS: tuple[Mutation, ...] = (_flip, _number, _nudge, _cut, _remove, _repeat, _overwrite, _word)


def spoil(content: bytes, random: Random) -> bytes:
    """Spoil bytes once or a few times."""
    data = bytearray(content)
    for _ in range(random.choice((1, 1, 1, 2, 4))):
        if data:
            random.choice(MUTATIONS)(data, random)
    return bytes(data)


def spoil_region(content: bytes, begin: int, end: int, random: Random) -> bytes:
    """Spoil one part, which keeps its length."""
    part = spoil(content[begin:end], random)[: end - begin]
    return content[:begin] + part.ljust(end - begin, b"\x00") + content[end:]


def spoil_archive(content: bytes, random: Random) -> bytes:
    """Spoil a member behind a sound directory and checksum, mostly within its header."""
    stream = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(content)) as old, zipfile.ZipFile(stream, "w") as new:
        chosen = random.choice(old.namelist())
        for item in old.infolist():
            member = old.read(item)
            if item.filename == chosen:
                head = random.choice((12, 128, len(member)))
                member = spoil(member[:head], random) + member[head:]
            name = item.filename if random.random() < 0.95 else random.choice(old.namelist())
            _write(new, name, member, item.compress_type)
    return stream.getvalue()


def _write(archive: zipfile.ZipFile, name: str, content: bytes, method: int) -> None:
    if name not in archive.namelist():
        archive.writestr(name, content, method)


def spoil_footer(content: bytes, random: Random) -> bytes:
    """Spoil a Parquet footer, which keeps its length, or a page's header at the beginning."""
    (length,) = struct.unpack("<I", content[-8:-4])
    if random.random() < 0.3:
        return spoil_region(content, 4, 4 + 60, random)
    return spoil_region(content, len(content) - 8 - length, len(content) - 8, random)


def spoil_element(content: bytes, random: Random) -> bytes:
    """Spoil one element of a MAT file, behind its compression where it has one."""
    elements, at = [], HEADER_MAT5
    while at + 8 <= len(content):
        kind, size = struct.unpack("<II", content[at : at + 8])
        elements.append((kind, content[at + 8 : at + 8 + size]))
        at += 8 + size
    chosen = random.randrange(len(elements))
    kind, inner = elements[chosen]
    if kind == COMPRESSED:
        unpacked = zlib.decompress(inner)
        head = min(len(unpacked), random.choice((16, 80, 100_000)))
        inner = zlib.compress(spoil(unpacked[:head], random) + unpacked[head:])
    else:
        inner = spoil_region(inner, 0, min(len(inner), random.choice((16, 80, 100_000))), random)
    elements[chosen] = (kind, inner)
    return content[:HEADER_MAT5] + b"".join(
        struct.pack("<II", kind, len(inner)) + inner for kind, inner in elements
    )


def spoil_metadata(content: bytes, random: Random) -> bytes:
    """Spoil an HDF5 file where its structure stands, around one of its signatures."""
    marks = [at for mark in SIGNATURES for at in _places(content, mark)]
    at = random.choice([0, *marks])
    return spoil_region(content, at, min(at + random.choice((48, 300)), len(content)), random)


def _places(content: bytes, mark: bytes) -> list[int]:
    places, at = [], content.find(mark)
    while at >= 0:
        places.append(at)
        at = content.find(mark, at + 1)
    return places


WITHIN: dict[str, Callable[[bytes, Random], bytes]] = {
    "CSV": spoil,
    "NPZ": spoil_archive,
    "Parquet": spoil_footer,
    "MATLAB v5": spoil_element,
    "HDF5": spoil_metadata,
    "MCAP": spoil,  # none of these is packed
    "SQLite": spoil,
    "ROS bag": spoil,
}


def spoilt(form: str, seeds: tuple[bytes, ...], random: Random) -> bytes:
    """Take a sound file of a format and spoil it, blindly or within."""
    content = random.choice(seeds)
    return (WITHIN[form] if random.random() < 0.6 else spoil)(content, random)
