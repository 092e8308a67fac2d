"""Hostile MAT files of version 5: sizes that lie, data that unpacks without end, and objects in objects."""

import io
import struct
import zlib

import numpy as np
from scipy.io import savemat

from tests.hostile.specimen import hostile, motion, zeros_deflated

FORM = "MATLAB v5"
HEADER = b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<HH", 0x0100, 0x4D49)
INT8, INT32, UINT32, DOUBLE, MATRIX, COMPRESSED = 1, 5, 6, 9, 14, 15
CELL, STRUCTURE, OBJECT, CHARACTERS, SPARSE, DOUBLES, BYTES, FUNCTION, OPAQUE = 1, 2, 3, 4, 5, 6, 8, 16, 17


def element(kind: int, content: bytes) -> bytes:
    return struct.pack("<II", kind, len(content)) + content + bytes(-len(content) % 8)


def matrix(kind: int, shape: tuple[int, ...], content: bytes, name: bytes = b"q_1") -> bytes:
    """Write a variable of any class that declares any shape."""
    flags = element(UINT32, struct.pack("<II", kind, 0))
    sizes = element(INT32, struct.pack(f"<{len(shape)}i", *shape))
    return element(MATRIX, flags + sizes + element(INT8, name) + content)


def sound() -> bytes:
    stream = io.BytesIO()
    columns = motion()
    del columns["q_1"]
    savemat(stream, columns, oned_as="row")
    return stream.getvalue()


def packed(size: int, head: bytes) -> bytes:
    """Pack a head and so many zeros as one compressed element."""
    content = zeros_deflated(size, head=head)
    return struct.pack("<II", COMPRESSED, len(content)) + content


@hostile(FORM)
def an_element_of_four_gigabytes(_place):
    return sound() + struct.pack("<II", MATRIX, 2**32 - 8) + bytes(100)


@hostile(FORM)
def an_element_without_length(_place):
    return sound() + struct.pack("<II", MATRIX, 0) * 3


@hostile(FORM)
def half_a_packed_gigabyte(_place):
    size = 1 << 29
    return sound() + packed(size, struct.pack("<II", MATRIX, size))


@hostile(FORM)
def half_a_packed_gigabyte_that_claims_to_be_small(_place):
    return sound() + packed(1 << 29, struct.pack("<II", MATRIX, 64))


@hostile(FORM)
def three_hundred_million_packed_bytes(_place):
    size = 300 << 20
    inner = matrix(BYTES, (1, size), b"")[8:] + struct.pack("<II", INT8, size)
    return sound() + packed(size, struct.pack("<II", MATRIX, len(inner) + size) + inner)


@hostile(FORM)
def bytes_that_stand_for_forty_million_numbers(_place):
    size = 38 << 20
    inner = matrix(DOUBLES, (1, size), b"")[8:] + struct.pack("<II", INT8, size)
    return sound() + packed(size, struct.pack("<II", MATRIX, len(inner) + size) + inner)


@hostile(FORM)
def a_shape_that_overflows(_place):
    return sound() + matrix(DOUBLES, (2**31 - 1, 2**31 - 1), element(DOUBLE, bytes(64)))


@hostile(FORM)
def a_negative_shape(_place):
    return sound() + matrix(DOUBLES, (-3, 5), element(DOUBLE, bytes(64)))


@hostile(FORM)
def a_shape_without_end(_place):
    return sound() + matrix(DOUBLES, (1,) * 5000, element(DOUBLE, bytes(8)))


@hostile(FORM)
def cells_in_cells_without_end(_place):
    inner = matrix(DOUBLES, (1, 1), element(DOUBLE, bytes(8)))
    for _ in range(3000):
        inner = matrix(CELL, (1, 1), inner)
    return sound() + inner


def structure(fields: int, width: int, content: bytes, shape: tuple[int, ...] = (1, 1)) -> bytes:
    names = b"".join(b"f%d".ljust(width)[:width].replace(b"%d", b"%d" % n) for n in range(fields))
    lengths = struct.pack("<HHI", INT32, 4, width)
    return matrix(STRUCTURE, shape, lengths + element(INT8, names) + content)


@hostile(FORM)
def structures_in_structures_without_end(_place):
    inner = matrix(DOUBLES, (1, 1), element(DOUBLE, bytes(8)), b"")
    names = element(INT8, b"a\0\0\0\0\0\0\0")
    frame = matrix(STRUCTURE, (1, 1), struct.pack("<HHI", INT32, 4, 8) + names, b"")[8:]
    frames, size = [], len(inner)
    while len(frames) < 20_000 and size <= 3_000_000:
        frames.append(struct.pack("<II", MATRIX, len(frame) + size) + frame)
        size += len(frames[-1])
    return sound() + b"".join(reversed(frames)) + inner


@hostile(FORM)
def a_structure_of_a_billion_records(_place):
    return sound() + structure(2, 8, b"", (30_000, 30_000))


@hostile(FORM)
def a_structure_with_names_of_no_length(_place):
    return sound() + matrix(STRUCTURE, (1, 1), struct.pack("<HHI", INT32, 4, 0) + element(INT8, b"abc"))


@hostile(FORM)
def a_billion_cells(_place):
    return sound() + matrix(CELL, (30_000, 30_000), b"")


@hostile(FORM)
def objects_for_numbers(_place):
    return sound() + matrix(OBJECT, (1, 1), element(INT8, b"double") + bytes(64))


@hostile(FORM)
def a_function_for_numbers(_place):
    return sound() + matrix(FUNCTION, (1, 1), matrix(DOUBLES, (1, 1), element(DOUBLE, bytes(8))))


@hostile(FORM)
def an_opaque_object_for_numbers(_place):
    return sound() + matrix(OPAQUE, (1, 1), element(INT8, b"java") + element(INT8, b"java.lang.Runtime"))


@hostile(FORM)
def a_sparse_matrix_that_points_anywhere(_place):
    rows = element(INT32, struct.pack("<4i", 2**30, -1, 5, 2**31 - 1))
    return sound() + matrix(SPARSE, (4, 4), rows + rows + element(DOUBLE, bytes(32)))


@hostile(FORM)
def a_variable_twice(_place):
    twice = matrix(DOUBLES, (1, 2), element(DOUBLE, bytes(16)))
    return sound() + twice + twice


@hostile(FORM)
def a_hundred_thousand_variables(_place):
    one = matrix(DOUBLES, (1, 1), element(DOUBLE, bytes(8)))
    return sound() + one * 100_000


@hostile(FORM)
def a_name_of_a_megabyte(_place):
    return sound() + matrix(DOUBLES, (1, 1), element(DOUBLE, bytes(8)), b"q" * (1 << 20))


@hostile(FORM)
def a_class_that_nobody_knows(_place):
    return sound() + matrix(99, (1, 1200), element(DOUBLE, bytes(8 * 1200)))


@hostile(FORM)
def a_file_cut_short(_place):
    return sound()[:10_000]


@hostile(FORM)
def a_header_and_noise(_place):
    return HEADER + np.random.default_rng(1).bytes(20_000)


@hostile(FORM)
def a_packed_element_in_a_packed_element(_place):
    inner = struct.pack("<II", COMPRESSED, 100) + zlib.compress(bytes(100))
    content = zlib.compress(inner)
    return HEADER + struct.pack("<II", COMPRESSED, len(content)) + content
