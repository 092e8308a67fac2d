"""Turn what a caller has into bytes that the service takes: files, data frames, arrays, descriptions."""

import io
import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from ...core.errors import LogError, RobotError

PIECE: Final = 1 << 20
LOG_TYPES: Final = {
    ".csv": "text/csv",
    ".tsv": "text/csv",
    ".txt": "text/csv",
    ".dat": "text/csv",
    ".parquet": "application/vnd.apache.parquet",
    ".pq": "application/vnd.apache.parquet",
    ".npz": "application/x-npz",
    ".mat": "application/x-matlab-data",
    ".h5": "application/x-hdf5",
    ".hdf5": "application/x-hdf5",
    ".mcap": "application/x-mcap",
    ".db3": "application/vnd.sqlite3",
    ".bag": "application/x-rosbag",
}


@dataclass(frozen=True)
class Parcel:
    """Carry bytes, or pieces of them, with their media type and a name."""

    content: bytes | Iterable[bytes]
    media_type: str
    name: str


def log_parcel(log: object, name: str) -> Parcel:
    """Wrap a log: a file, a mapping of arrays by column, or a data frame.

    Raises
    ------
    LogError
        If it is none of these, or the file cannot be read.
    """
    if isinstance(log, str | Path):
        path = Path(log)
        require_file(path, LogError)
        media_type = LOG_TYPES.get(path.suffix.lower(), "application/octet-stream")
        return Parcel(_pieces(path), media_type, name or path.name)
    if isinstance(log, Mapping):
        return Parcel(_npz(log), LOG_TYPES[".npz"], name or "log")
    if hasattr(log, "__arrow_c_stream__"):
        return Parcel(_parquet(log), LOG_TYPES[".parquet"], name or "log")
    raise LogError(
        f"a {type(log).__name__} is not a log",
        evidence={"given": type(log).__name__},
        remedy="give a file, a data frame of columns, or a mapping of arrays by column",
    )


def robot_parcel(robot: Path | Mapping[str, object]) -> Parcel:
    """Wrap a robot's description: a JSON file, a URDF, or the description itself.

    Raises
    ------
    RobotError
        If the file cannot be read.
    """
    if isinstance(robot, Mapping):
        return Parcel(json.dumps(robot).encode(), "application/json", str(robot.get("name", "")))
    require_file(robot, RobotError)
    content = robot.read_bytes()
    is_json = robot.suffix == ".json" or content.lstrip()[:1] in (b"{", b"[")
    return Parcel(content, "application/json" if is_json else "application/xml", robot.stem)


def require_file(path: Path, error: type[LogError] | type[RobotError]) -> None:
    """Return where there is a file to read.

    Raises
    ------
    LogError, RobotError
        If there is none, or it may not be read.
    """
    try:
        path.open("rb").close()
    except OSError as reason:
        raise error(
            f"{path} cannot be read",
            evidence={"reason": reason.strerror or str(reason)},
            remedy="name a file that is there",
        ) from reason


def _pieces(path: Path) -> Iterator[bytes]:
    with path.open("rb") as stream:
        while piece := stream.read(PIECE):
            yield piece


def _npz(arrays: Mapping[str, Any]) -> bytes:
    import numpy as np

    buffer = io.BytesIO()
    np.savez(buffer, allow_pickle=False, **{str(name): np.asarray(array) for name, array in arrays.items()})
    return buffer.getvalue()


def _parquet(frame: Any) -> bytes:  # noqa: ANN401  # anything with an Arrow stream
    import pyarrow as pa
    import pyarrow.parquet as pq

    buffer = io.BytesIO()
    pq.write_table(pa.table(frame), buffer)
    return buffer.getvalue()
