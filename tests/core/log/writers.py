"""Make a healthy log, spoil it, and write it in every format: the test side of veritorque.core.log."""

import io
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from scipy.io import savemat

Columns = dict[str, np.ndarray]


def swing(seconds: float = 12.0, rate_hz: float = 250.0, joints: int = 3, seed: int = 0) -> Columns:
    """Swing each joint by two sines; torque follows with friction and noise, position with a little noise."""
    random = np.random.default_rng(seed)
    time = np.arange(round(seconds * rate_hz)) / rate_hz
    columns = {"time": time}
    for joint in range(joints):
        slow, quick = 0.7 + 0.1 * joint, 2.1 + 0.3 * joint
        position = np.sin(2 * np.pi * 0.3 * slow * time) + 0.3 * np.sin(
            2 * np.pi * 0.3 * quick * time + joint
        )
        columns[f"q_{joint + 1}"] = position + 1e-6 * random.standard_normal(len(time))
    for joint in range(joints):
        position = columns[f"q_{joint + 1}"]
        friction = np.tanh(50 * np.gradient(position, time))
        columns[f"tau_{joint + 1}"] = 10 * position + friction + 0.05 * random.standard_normal(len(time))
    return columns


def write_csv(path: Path, columns: Columns, delimiter: str = ",", before: str = "") -> Path:
    stream = io.StringIO()
    stream.write(before + delimiter.join(columns) + "\n")
    np.savetxt(stream, np.column_stack(list(columns.values())), delimiter=delimiter, fmt="%.17g")
    path.write_text(stream.getvalue(), encoding="utf-8")
    return path


def write_tsv(path: Path, columns: Columns) -> Path:
    return write_csv(path, columns, "\t")


def write_parquet(path: Path, columns: Columns, group: int | None = None) -> Path:
    pq.write_table(pa.table(columns), path, row_group_size=group)
    return path


def matrices(columns: Columns) -> Columns:
    """Gather q_1.. and tau_1.. into matrices of samples by joints, as NPZ and MAT files hold them."""
    joints = sum(name.startswith("q_") for name in columns)
    gathered = {
        prefix: np.column_stack([columns[f"{prefix}_{j + 1}"] for j in range(joints)])
        for prefix in ("q", "tau")
    }
    return {"time": columns["time"], **gathered}


def write_npz(path: Path, columns: Columns) -> Path:
    np.savez_compressed(path, **matrices(columns))
    return path


def write_mat5(path: Path, columns: Columns) -> Path:
    savemat(path, matrices(columns), do_compression=True, oned_as="row")
    return path


def write_mat7(path: Path, columns: Columns) -> Path:
    """Write as MATLAB does: a user block with its text, and matrices transposed."""
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in matrices(columns).items():
            file.create_dataset(name, data=np.atleast_2d(values).T.T if values.ndim == 1 else values.T)
            file[name].attrs["MATLAB_class"] = np.bytes_("double")
    with path.open("r+b") as stream:
        stream.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM")
    return path


WRITERS: dict[str, tuple[str, Callable[[Path, Columns], Path]]] = {
    "CSV": ("log.csv", write_csv),
    "TSV": ("log.tsv", write_tsv),
    "Parquet": ("log.parquet", write_parquet),
    "NPZ": ("log.npz", write_npz),
    "MATLAB v5": ("log.mat", write_mat5),
    "MATLAB v7.3": ("log.mat", write_mat7),
}
