"""Make small sound logs in every format, in the variants that their writers know; spoilt ones begin here."""

import io
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path

import h5py
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from scipy.io import savemat

from tests.core.log.recordings import write_bag, write_mcap, write_sqlite

ROWS = 120


def columns() -> dict[str, np.ndarray]:
    time = np.arange(ROWS) / 100.0
    return {
        "time": time,
        "q_1": np.sin(3.0 * time),
        "tau_1": 5.0 * np.cos(3.0 * time) + 0.1 * np.sin(40 * time),
    }


def csv(delimiter: str) -> bytes:
    rows = [delimiter.join(f"{value:.5g}" for value in row) for row in zip(*columns().values(), strict=True)]
    return "\n".join(["# made by a robot", delimiter.join(columns()), *rows]).encode()


def npz(*, packed: bool) -> bytes:
    stream = io.BytesIO()
    (np.savez_compressed if packed else np.savez)(stream, **columns(), note=np.array("text"))
    return stream.getvalue()


def parquet(**options: object) -> bytes:
    stream = io.BytesIO()
    pq.write_table(pa.table(columns() | {"note": ["text"] * ROWS}), stream, row_group_size=50, **options)
    return stream.getvalue()


def matlab5(*, packed: bool) -> bytes:
    stream = io.BytesIO()
    nested = {"arm": {"pos": columns()["q_1"], "inner": {"a": 1.0}}, "note": "text"}
    cells = np.array([1.0, "a"], dtype=object)
    savemat(stream, columns() | nested | {"cells": cells}, do_compression=packed, oned_as="row")
    return stream.getvalue()


def hdf5(*, packed: bool, libver: str | None = None) -> bytes:
    stream = io.BytesIO()
    options = {"compression": "gzip", "chunks": (40,), "shuffle": True} if packed else {}
    with h5py.File(stream, "w", libver=libver) as file:
        for name, values in columns().items():
            file.create_dataset(name, data=values, **options)
            file[name].attrs["MATLAB_class"] = np.bytes_("double")
        file["arm/pos"] = columns()["q_1"]
        file["note"] = "text"
    return stream.getvalue()


def recording(write: Callable[..., Path]) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        return write(Path(folder), columns() | {"qd_1": columns()["q_1"]}, {"joint1": 1}).read_bytes()


@cache
def seeds() -> dict[str, tuple[bytes, ...]]:
    """Give the sound files by format."""
    return {
        "CSV": (csv(","), csv(";"), csv("\t"), csv("\t").decode().encode("utf-16")),
        "NPZ": (npz(packed=False), npz(packed=True)),
        "Parquet": (
            parquet(),
            parquet(compression="none", use_dictionary=False, data_page_version="2.0"),
            parquet(compression="zstd", use_byte_stream_split=["q_1"], use_dictionary=["note"]),
        ),
        "MATLAB v5": (matlab5(packed=False), matlab5(packed=True)),
        "MCAP": (recording(write_mcap),),
        "SQLite": (recording(write_sqlite),),
        "ROS bag": (recording(write_bag),),
        "HDF5": (hdf5(packed=False), hdf5(packed=True), hdf5(packed=True, libver="latest")),
    }
