"""Read NumPy's NPZ archives without ever unpickling: an array's header says what it is before it is read.

An archive is checked as a whole first, since a member that unpacks to terabytes or holds Python objects costs
a few bytes.
"""

import zipfile
from math import prod
from pathlib import Path

import numpy as np

from core.errors import LogError
from core.log.boundary import reading
from core.log.table import MAX_COLUMNS, MemoryTable, check_columns, check_values, expand

FORM = "NPZ"
MAX_HEADER_BYTES = 10_000


def open_npz(path: Path) -> MemoryTable:
    """Read all arrays of the archive.

    Raises
    ------
    LogError
        If the archive is damaged, encrypted or too large, or one of its members is a pickled object.
    """
    with reading(FORM, path), zipfile.ZipFile(path) as archive:
        members = [item for item in archive.infolist() if item.filename.endswith(".npy")]
        if not members:
            raise LogError(
                "the archive holds no arrays",
                evidence={"members": archive.namelist()[:20]},
                remedy="write it by numpy.savez, or upload the table itself",
            )
        check_columns([item.filename for item in members[: MAX_COLUMNS + 1]])
        check_values(sum(item.file_size for item in members) // 8)
        variables = {item.filename.removesuffix(".npy"): _array(archive, item) for item in members}
    return expand(variables)


def _array(archive: zipfile.ZipFile, item: zipfile.ZipInfo) -> np.ndarray | None:
    """Read one member; None where it is not made of real numbers."""
    shape, dtype = _header(archive, item)
    if dtype.hasobject:
        raise LogError(
            "the archive holds a pickled Python object, which is never read because it could run code",
            evidence={"array": item.filename.removesuffix(".npy"), "dtype": str(dtype)},
            remedy="save plain numeric arrays only",
        )
    if dtype.kind not in "iuf" or len(shape) not in (1, 2):
        return None
    if prod(shape) * dtype.itemsize > item.file_size:
        raise LogError(
            "an array of the archive is shorter than its header says",
            evidence={
                "array": item.filename.removesuffix(".npy"),
                "shape": list(shape),
                "bytes": item.file_size,
            },
            remedy="write the archive again",
        )
    with archive.open(item) as stream:
        values: np.ndarray = np.lib.format.read_array(stream, allow_pickle=False)
    return values


def _header(archive: zipfile.ZipFile, item: zipfile.ZipInfo) -> tuple[tuple[int, ...], np.dtype]:
    with archive.open(item) as stream:
        form = np.lib.format
        version = form.read_magic(stream)
        read = form.read_array_header_1_0 if version == (1, 0) else form.read_array_header_2_0
        shape, _, dtype = read(stream, max_header_size=MAX_HEADER_BYTES)
    return shape, dtype
