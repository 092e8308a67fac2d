"""Hostile HDF5: files that point at others, unpack without end, or are built to exhaust who walks them."""

import zlib
from collections.abc import Callable
from typing import Any

import h5py
import numpy as np

from tests.hostile.specimen import ROWS, Place, hostile, motion, zeros_deflated

FORM = "HDF5"


def written(place: Place, change: Callable[[Any], None], *, without: str = "", **options: Any) -> bytes:
    """Write a sound log, without one column, and let a change spoil it."""
    path = place.folder / "made.h5"
    with h5py.File(path, "w", **options) as file:
        for name, values in motion().items():
            if name != without:
                file[name] = values
        change(file)
    return path.read_bytes()


@hostile(FORM)
def an_external_link_for_a_column(place):
    return written(
        place, lambda f: f.__setitem__("q_1", h5py.ExternalLink(place.secret_hdf5, "q")), without="q_1"
    )


@hostile(FORM)
def an_external_link_beside_the_log(place):
    return written(place, lambda f: f.__setitem__("other", h5py.ExternalLink("/etc/passwd", "/")))


@hostile(FORM)
def an_external_link_up_the_folders(place):
    link = h5py.ExternalLink("../../../../../../etc/shadow", "/")
    return written(place, lambda f: f.__setitem__("q_1", link), without="q_1")


@hostile(FORM)
def a_soft_link_that_leads_to_an_external_one(place):
    def change(file):
        file["hidden"] = h5py.ExternalLink(place.secret_hdf5, "/")
        file["q_1"] = h5py.SoftLink("/hidden/q")

    return written(place, change, without="q_1")


@hostile(FORM)
def a_soft_link_to_nothing(place):
    return written(place, lambda f: f.__setitem__("q_1", h5py.SoftLink("/etc/passwd")), without="q_1")


@hostile(FORM)
def a_soft_link_to_itself(place):
    return written(place, lambda f: f.__setitem__("q_1", h5py.SoftLink("/q_1")), without="q_1")


@hostile(FORM)
def external_storage_in_another_file(place):
    outside = [(str(place.secret), 0, 8 * ROWS)]
    return written(place, lambda f: f.create_dataset("q_1", (ROWS,), "f8", external=outside), without="q_1")


@hostile(FORM)
def external_storage_in_a_system_file(place):
    outside = [("/etc/passwd", 0, 8 * ROWS)]
    return written(place, lambda f: f.create_dataset("q_1", (ROWS,), "f8", external=outside), without="q_1")


@hostile(FORM)
def external_storage_in_a_device(place):
    outside = [("/dev/zero", 0, 8 * ROWS)]
    return written(place, lambda f: f.create_dataset("q_1", (ROWS,), "f8", external=outside), without="q_1")


def virtual(source: str, name: str) -> Callable[[Any], None]:
    def change(file):
        layout = h5py.VirtualLayout(shape=(ROWS,), dtype="f8")
        layout[:] = h5py.VirtualSource(source, name, shape=(ROWS,))
        file.create_virtual_dataset("q_1", layout)

    return change


@hostile(FORM)
def a_virtual_dataset_of_another_file(place):
    return written(place, virtual(str(place.secret_hdf5), "q"), without="q_1")


@hostile(FORM)
def a_virtual_dataset_of_the_same_file(place):
    return written(place, virtual(".", "q_2"), without="q_1")


@hostile(FORM)
def a_virtual_dataset_of_standard_input(place):
    return written(place, virtual("/dev/stdin", "q"), without="q_1")


@hostile(FORM)
def object_references_for_numbers(place):
    def change(file):
        file.create_dataset("q_1", data=np.array([file["q_2"].ref] * ROWS, dtype=h5py.ref_dtype))

    return written(place, change, without="q_1")


@hostile(FORM)
def text_of_any_length_for_numbers(place):
    def change(file):
        file.create_dataset("q_1", data=np.array(["1.0"] * ROWS, dtype=object), dtype=h5py.string_dtype())

    return written(place, change, without="q_1")


@hostile(FORM)
def lists_of_any_length_for_numbers(place):
    def change(file):
        lists = file.create_dataset("q_1", (ROWS,), dtype=h5py.vlen_dtype(np.float64))
        lists[0] = np.zeros(1000)

    return written(place, change, without="q_1")


@hostile(FORM)
def records_for_numbers(place):
    records = np.zeros(ROWS, dtype=[("a", "f8"), ("b", "S400")])
    return written(place, lambda f: f.__setitem__("q_1", records), without="q_1")


@hostile(FORM)
def opaque_bytes_for_numbers(place):
    return written(place, lambda f: f.__setitem__("q_1", np.zeros(ROWS, dtype="V64")), without="q_1")


@hostile(FORM)
def a_trillion_values_that_take_no_room(place):
    return written(place, lambda f: f.create_dataset("x", (10**12,), "f8", chunks=(1000,)))


@hostile(FORM)
def forty_million_values_that_take_no_room(place):
    return written(place, lambda f: f.create_dataset("q", (39_900_000, 1), "f8", chunks=(1000, 1)))


@hostile(FORM)
def a_shape_whose_product_overflows(place):
    return written(place, lambda f: f.create_dataset("x", (2**40, 2**40), "i1", chunks=(1024, 1024)))


@hostile(FORM)
def a_chunk_that_inflates_to_half_a_gigabyte(place):
    def change(file):
        chunked = file.create_dataset("q_1", (ROWS,), "f8", chunks=(ROWS,), compression="gzip")
        chunked.id.write_direct_chunk((0,), zeros_deflated(1 << 29))

    return written(place, change, without="q_1")


@hostile(FORM)
def a_chunk_packed_twice(place):
    def change(file):
        creation = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        creation.set_chunk((ROWS,))
        creation.set_deflate(9)
        creation.set_deflate(9)
        space = h5py.h5s.create_simple((ROWS,))
        made = h5py.h5d.create(file.id, b"q_1", h5py.h5t.IEEE_F64LE, space, creation)
        made.write_direct_chunk((0,), zlib.compress(zeros_deflated(1 << 29), 9))

    return written(place, change, without="q_1")


@hostile(FORM)
def forty_million_equal_values_well_packed(place):
    def change(file):
        file.create_dataset("q", (39_000_000, 1), "f8", chunks=(3_900_000, 1), compression="gzip", data=None)
        packed = zeros_deflated(8 * 3_900_000)
        for begin in range(0, 39_000_000, 3_900_000):
            file["q"].id.write_direct_chunk((begin, 0), packed)

    return written(place, change, without="time")


@hostile(FORM)
def a_filter_of_a_plug_in(place):
    def change(file):
        creation = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        creation.set_chunk((ROWS,))
        creation.set_filter(32_015, h5py.h5z.FLAG_OPTIONAL, (3,))
        space = h5py.h5s.create_simple((ROWS,))
        h5py.h5d.create(file.id, b"q_1", h5py.h5t.IEEE_F64LE, space, creation)

    return written(place, change, without="q_1")


@hostile(FORM)
def twenty_thousand_empty_groups(place):
    return written(place, lambda f: [f.create_group(f"g{n}") for n in range(20_000)], libver="latest")


@hostile(FORM)
def groups_two_thousand_deep(place):
    def change(file):
        inner = file
        for _ in range(2000):
            inner = inner.create_group("g")

    return written(place, change)


@hostile(FORM)
def two_thousand_columns(place):
    return written(place, lambda f: [f.create_dataset(f"c{n}", (2,), "f8") for n in range(2000)])


@hostile(FORM)
def groups_that_hold_each_other(place):
    def change(file):
        file["a/b/c"] = np.zeros(3)
        file["a/b/a"] = file["a"]

    return written(place, change, without="time")


@hostile(FORM)
def a_class_name_of_twenty_megabytes(place):
    def change(file):
        file["q_1"].attrs.create("MATLAB_class", np.zeros(20_000_000, dtype="i1"))
        del file["tau_1"]

    return written(place, change, libver="latest")


@hostile(FORM)
def a_column_without_values(place):
    return written(place, lambda f: f.__setitem__("q_1", h5py.Empty("f8")), without="q_1")


@hostile(FORM)
def a_name_that_is_not_text(place):
    return written(place, lambda f: f.create_dataset(b"q_\xff\xfe", data=np.zeros(3)), without="q_1")


@hostile(FORM)
def a_file_cut_short(place):
    return written(place, lambda _: None)[:3000]


@hostile(FORM)
def a_signature_and_noise(_place):
    return b"\x89HDF\r\n\x1a\n" + np.random.default_rng(1).bytes(20_000)


@hostile(FORM)
def a_matlab_header_and_noise(_place):
    return b"MATLAB 7.3 MAT-file".ljust(512) + np.random.default_rng(2).bytes(20_000)


@hostile(FORM)
def a_root_group_full_of_noise(place):
    whole = bytearray(written(place, lambda _: None))
    whole[96:1200] = np.random.default_rng(3).bytes(1104)
    return bytes(whole)
