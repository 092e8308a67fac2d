"""Read MAT files of version 5 (saved by -v6 or -v7); structures of arrays flatten to `structure.field`.

The size that each compressed variable unpacks to stands in its own first tag, and its shape in the header
behind, so that it can be refused before it is unpacked. Cells, objects and other things which hold no log are
never unpacked at all. Source: MathWorks, MAT-File Format (version 5), data element tags.
"""

import struct
import warnings
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import LogError
from .table import (
    MAX_COLUMNS,
    MemoryTable,
    check_columns,
    check_density,
    check_shapes,
    check_values,
    expand,
    reading,
)

FORM = "MATLAB v5"
HEADER_BYTES = 128
COMPRESSED = 15
MAX_DEPTH = 4
MAX_VARIABLES = 4 * MAX_COLUMNS
INTEGERS = (f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64))
NUMERIC = frozenset({"double", "single", *INTEGERS})
STRUCTURE = "struct"


def open_matlab5(path: Path) -> MemoryTable:
    """Read all variables.

    Raises
    ------
    LogError
        If the file is damaged, cut short or too large.
    """
    from scipy.io.matlab import loadmat, whosmat

    with reading(FORM, path), warnings.catch_warnings():
        warnings.simplefilter("error")  # scipy warns of variables that occur twice
        unpacked = sum(_unpacked_sizes(path))
        check_values(unpacked // 8)
        check_density(unpacked, path.stat().st_size)
        declared = whosmat(path, appendmat=False)
        check_shapes([shape for _, shape, kind in declared if kind in NUMERIC])
        wanted = [name for name, _, kind in declared if kind in NUMERIC or kind == STRUCTURE]
        found = loadmat(path, appendmat=False, variable_names=wanted, verify_compressed_data_integrity=True)
        variables = dict(_flat((name, found.get(name), 0) for name, _, _ in declared))
    return expand(variables)


def _unpacked_sizes(path: Path) -> Iterator[int]:
    """Give the bytes that each variable takes once unpacked."""
    with path.open("rb") as stream:
        header = stream.read(HEADER_BYTES)
        order = "<" if header[126:128] == b"IM" else ">"
        end, variables = path.stat().st_size, 0
        while (offset := stream.tell()) < end:
            variables += 1
            if variables > MAX_VARIABLES:
                raise LogError(
                    "the MATLAB file holds more variables than a log has",
                    evidence={"at_most": MAX_VARIABLES},
                    remedy="save the variables of the log only",
                )
            kind, size = struct.unpack(order + "II", stream.read(8))
            if offset + 8 + size > end:
                raise LogError(
                    "the MATLAB file is cut short",
                    evidence={"bytes": end, "needs_at_least": offset + 8 + size},
                    remedy="save the file again and upload it whole",
                )
            yield _inner_size(stream.read(min(size, 1024)), order) if kind == COMPRESSED else size
            stream.seek(offset + 8 + size)


def _inner_size(head: bytes, order: str) -> int:
    tag = zlib.decompressobj().decompress(head, 8)
    return int(struct.unpack(order + "II", tag)[1])


def _flat(items: Any) -> Iterator[tuple[str, np.ndarray | None]]:  # noqa: ANN401  # scipy gives any type
    """Walk into structures; None stands for what is no array of numbers."""
    for name, value, depth in items:
        array = np.asarray(value)
        if array.dtype.names is None:
            yield name, array if array.dtype.kind in "iuf" else None
        elif array.size == 1 and depth < MAX_DEPTH:
            check_columns(array.dtype.names[: MAX_COLUMNS + 1])
            record = array.reshape(-1)[0]
            yield from _flat((f"{name}.{field}", record[field], depth + 1) for field in array.dtype.names)
        else:
            yield name, None
