"""Read NumPy's NPZ archives without ever unpickling: an array's header says what it is before it is read.

An archive is checked as a whole first, since a member that unpacks to terabytes or holds Python objects costs
a few bytes: its directory's own size, then the headers of all arrays, then the arrays.
Source: PKWARE, APPNOTE.TXT 6.3.10, 4.3.16 (end of central directory record).
"""

import struct
import warnings
import zipfile
from math import prod
from pathlib import Path

import numpy as np

from ...errors import LogError
from .table import MAX_COLUMNS, MemoryTable, check_columns, check_density, check_shapes, expand, reading

FORM = "NPZ"
MAX_HEADER_BYTES = 10_000
MAX_MEMBERS = 2 * MAX_COLUMNS
MAX_DIRECTORY_BYTES = 1 << 19
LONGEST_COMMENT = (1 << 16) - 1
END_SIGNATURE = b"PK\x05\x06"
END_RECORD = struct.Struct("<10sHI6x")  # signature and disks; members; bytes of the directory; place, comment


def open_npz(path: Path) -> MemoryTable:
    """Read all arrays of the archive.

    Raises
    ------
    LogError
        If the archive is damaged, encrypted or too large, or one of its members is a pickled object.
    """
    _check_directory(path)
    with reading(FORM, path), warnings.catch_warnings(), zipfile.ZipFile(path) as archive:
        warnings.simplefilter("ignore")  # numpy warns when an array was written by Python 2
        members = _members(archive)
        check_columns([item.filename for item in members[: MAX_COLUMNS + 1]])
        check_density(sum(item.file_size for item in members), path.stat().st_size)
        numeric = {item.filename: _numeric_shape(archive, item) for item in members}
        check_shapes([shape for shape in numeric.values() if shape is not None])
        variables = {
            item.filename.removesuffix(".npy"): (
                None if numeric[item.filename] is None else _array(archive, item)
            )
            for item in members
        }
    return expand(variables)


def _members(archive: zipfile.ZipFile) -> list[zipfile.ZipInfo]:
    members = [item for item in archive.infolist() if item.filename.endswith(".npy")]
    if not members:
        raise LogError(
            "the archive holds no arrays",
            evidence={"members": archive.namelist()[:20]},
            remedy="write it by numpy.savez, or upload the table itself",
        )
    return members


def _check_directory(path: Path) -> None:
    """Refuse a directory that is longer than that of any log, before it is read."""
    with path.open("rb") as stream:
        stream.seek(max(path.stat().st_size - END_RECORD.size - LONGEST_COMMENT, 0))
        tail = stream.read()
    at = tail.rfind(END_SIGNATURE)
    if at < 0 or len(tail) - at < END_RECORD.size:
        raise LogError(
            "the archive has no directory: it is cut short",
            evidence={"bytes": path.stat().st_size},
            remedy="write the file again and upload it whole",
        )
    _, members, size = END_RECORD.unpack_from(tail, at)
    if members > MAX_MEMBERS or size > MAX_DIRECTORY_BYTES:
        raise LogError(
            "the archive has more members than a log has arrays",
            evidence={"members": members, "at_most": MAX_MEMBERS, "directory_bytes": size},
            remedy="save the arrays of the log only, by numpy.savez",
        )


def _array(archive: zipfile.ZipFile, item: zipfile.ZipInfo) -> np.ndarray:
    with archive.open(item) as stream:
        values: np.ndarray = np.lib.format.read_array(stream, allow_pickle=False)
    return values


def _numeric_shape(archive: zipfile.ZipFile, item: zipfile.ZipInfo) -> tuple[int, ...] | None:
    """Give what the header of one member says; None where it is not made of real numbers."""
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
    return shape


def _header(archive: zipfile.ZipFile, item: zipfile.ZipInfo) -> tuple[tuple[int, ...], np.dtype]:
    with archive.open(item) as stream:
        form = np.lib.format
        version = form.read_magic(stream)
        read = form.read_array_header_1_0 if version == (1, 0) else form.read_array_header_2_0
        shape, _, dtype = read(stream, max_header_size=MAX_HEADER_BYTES)
    return shape, dtype
