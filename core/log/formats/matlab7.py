"""Read MAT files of version 7.3, which are HDF5, and plain HDF5 files of the same shape.

HDF5 can point at other files on the machine that reads it (external links, external storage, virtual
datasets); such files are refused. Source: HDF Group, HDF5 file format specification, link and layout
messages.
"""

from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import LogError
from .table import MAX_COLUMNS, MemoryTable, check_columns, check_density, check_shapes, expand, reading

FORM = "MATLAB v7.3"
MAX_MEMBERS = 4 * MAX_COLUMNS
MAX_DEPTH = 16
LONGEST_CLASS = 64
TEXT = (b"char", b"cell")
FILTERS = frozenset({1, 2, 3})
"""Deflate, shuffle and checksum, by HDF5's numbers: what MATLAB writes, and no plug-in."""


def open_matlab7(path: Path) -> MemoryTable:
    """Read all numeric datasets; groups are structures and flatten to `structure.field`.

    Raises
    ------
    LogError
        If the file is damaged or too large, or refers to data outside itself.
    """
    import h5py

    # Whoever set the file aside may hold a lock on it, which the library would take for another writer's.
    with reading(FORM, path), h5py.File(path, "r", locking=False) as file:
        datasets = dict(islice(_datasets(file, "", set()), MAX_COLUMNS + 1))
        check_columns(list(datasets))
        readable = {name: dataset for name, dataset in datasets.items() if dataset is not None}
        check_shapes([dataset.shape for dataset in readable.values()])
        check_density(sum(dataset.nbytes for dataset in readable.values()), path.stat().st_size)
        variables = {name: np.asarray(readable[name][()]) if name in readable else None for name in datasets}
    return expand(variables)


def _datasets(group: Any, prefix: str, seen: set[int]) -> Iterator[tuple[str, Any]]:  # noqa: ANN401  # h5py gives any type
    """Walk the datasets by hard links only; None stands for what is no array of numbers."""
    import h5py

    _check_size(max(len(group), len(seen)), prefix)
    for key in group:
        name = f"{prefix}{key}"
        if key.startswith("#"):  # MATLAB's own bookkeeping of cells
            continue
        if not isinstance(group.get(key, getlink=True), h5py.HardLink):
            raise _refers_outside(name, "a link to another place or file")
        item = group[key]
        if isinstance(item, h5py.Dataset):
            _check_storage(name, item)
            yield name, _numeric(item)
        elif isinstance(item, h5py.Group) and (address := h5py.h5o.get_info(item.id).addr) not in seen:
            seen.add(address)  # groups may hold each other: each is entered once
            yield from _datasets(item, f"{name}.", seen)


def _numeric(dataset: Any) -> Any:  # noqa: ANN401  # h5py gives any type
    numeric = dataset.dtype.kind in "iuf" and dataset.ndim in (1, 2) and "MATLAB_empty" not in dataset.attrs
    return dataset if numeric and not _is_text(dataset) else None


def _is_text(dataset: Any) -> bool:  # noqa: ANN401  # h5py gives any type
    """Recognise MATLAB's text, which is stored as 16-bit numbers."""
    if "MATLAB_class" not in dataset.attrs:
        return False
    named = dataset.attrs.get_id("MATLAB_class")
    return named.get_storage_size() <= LONGEST_CLASS and bytes(dataset.attrs["MATLAB_class"]) in TEXT


def _check_storage(name: str, dataset: Any) -> None:  # noqa: ANN401  # h5py gives any type
    if dataset.is_virtual:
        raise _refers_outside(name, "a virtual dataset")
    if dataset.external:
        raise _refers_outside(name, "external storage")
    properties = dataset.id.get_create_plist()
    filters = [properties.get_filter(index)[0] for index in range(properties.get_nfilters())]
    if not FILTERS.issuperset(filters) or len(set(filters)) < len(filters):
        raise LogError(
            "a dataset is packed in a way that is not read here",
            evidence={"dataset": name, "filters": filters, "known": sorted(FILTERS)},
            remedy="save it unpacked, or with gzip, once",
        )


def _check_size(members: int, path: str) -> None:
    if members > MAX_MEMBERS or path.count(".") > MAX_DEPTH:
        raise LogError(
            "the file holds more groups than a log has",
            evidence={"in": path[:100], "at_most": MAX_MEMBERS, "deepest": MAX_DEPTH},
            remedy="save the datasets of the log only",
        )


def _refers_outside(name: str, what: str) -> LogError:
    return LogError(
        "the file refers to data outside itself, which is never followed",
        evidence={"dataset": name, "found": what},
        remedy="save the numbers in the file itself",
    )
