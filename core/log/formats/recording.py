"""Read the joint states of ROS recordings: MCAP files of ROS 2 and bags of ROS 1.

Only messages of the type sensor_msgs/JointState are decoded, by the definition that is built in: one that a
recording brings along would have to be compiled. Joints keep their names, because their order in a message
says nothing about the robot. Sources: MCAP format specification; ROS bag format 2.0; sensor_msgs/JointState.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import LogError
from .table import MemoryTable, check_columns, check_density, check_values, reading

MCAP_FORM, BAG_FORM = "MCAP", "ROS bag"
JOINT_STATE = "sensor_msgs/msg/JointState"
NANOSECONDS = 1_000_000_000
FIELDS = ("position", "velocity", "effort")


@dataclass(frozen=True)
class State:
    """Carry one message: stamp in ns, and what it says of its joints."""

    stamp: int
    joints: tuple[str, ...]
    values: dict[str, np.ndarray]


def open_mcap(path: Path) -> MemoryTable:
    """Read the joint states of an MCAP file.

    Raises
    ------
    LogError
        If the file is damaged or too large, or holds no joint states or several topics of them.
    """
    _require_library()
    from rosbags.rosbag2.storage_mcap import McapReader

    with reading(MCAP_FORM, path):
        reader = McapReader(path)
        reader.open()
        try:
            check_density(sum(chunk.uncompressed_size for chunk in reader.chunks), path.stat().st_size)
            topic = _joint_states(reader.connections)
            return _table(_decode(reader.messages(topic), ros1=False))
        finally:
            reader.close()


def open_bag(path: Path) -> MemoryTable:
    """Read the joint states of a bag of ROS 1.

    Raises
    ------
    LogError
        If the file is damaged or too large, or holds no joint states or several topics of them.
    """
    _require_library()
    from rosbags.rosbag1 import Reader

    with reading(BAG_FORM, path), Reader(path) as reader:
        topic = _joint_states(reader.connections)
        return _table(_decode(reader.messages(topic), ros1=True))


def _require_library() -> None:
    try:
        import rosbags.typesys  # noqa: F401 - only whether it is there
    except ImportError as error:
        raise LogError(
            "ROS recordings are not read here, because an optional part is not installed",
            evidence={"missing": "rosbags"},
            remedy="let the operator install veritorque[ros], or export the joint states as CSV or Parquet",
        ) from error


def _joint_states(connections: Any) -> list[Any]:  # noqa: ANN401  # both readers' own types
    found = [connection for connection in connections if connection.msgtype == JOINT_STATE]
    topics = sorted({connection.topic for connection in found})
    if len(topics) != 1:
        raise LogError(
            "the recording has several topics of joint states"
            if topics
            else "the recording has no joint states",
            evidence={
                "topics": (topics or sorted({connection.topic for connection in connections}))[:20],
                "needed": JOINT_STATE,
            },
            remedy="record one topic of this type, or export the one that is meant as CSV or Parquet",
        )
    return found


def _decode(messages: Any, *, ros1: bool) -> Iterator[State]:  # noqa: ANN401  # both readers' own types
    from rosbags.typesys import Stores, get_typestore

    types = get_typestore(Stores.ROS1_NOETIC if ros1 else Stores.ROS2_HUMBLE)
    decode = types.deserialize_ros1 if ros1 else types.deserialize_cdr
    for _, received, raw in messages:
        message: Any = decode(raw, JOINT_STATE)
        stamp = message.header.stamp.sec * NANOSECONDS + message.header.stamp.nanosec
        values = {field: np.asarray(getattr(message, field), dtype=np.float64) for field in FIELDS}
        yield State(stamp or received, tuple(message.name), values)


def _table(states: Iterator[State]) -> MemoryTable:
    """Gather the messages into columns `position.<joint>`, `velocity.<joint>` and `effort.<joint>`."""
    first = next(states, None)
    if first is None:
        raise LogError("the recording holds no messages", evidence={"messages": 0}, remedy="record a motion")
    width = len(first.joints)
    fields = [field for field in FIELDS if width and len(first.values[field]) == width]
    names = [f"{field}.{joint}" for field in fields for joint in first.joints]
    check_columns(names)
    stamps, rows = [first.stamp], [_row(first, first, fields)]
    for state in states:
        check_values(len(rows) * (len(names) + 1))
        stamps.append(state.stamp)
        rows.append(_row(state, first, fields))
    block = np.array(rows).T
    time = (np.array(stamps, dtype=np.int64) - stamps[0]) / NANOSECONDS
    return MemoryTable({"time": time} | dict(zip(names, block, strict=True)))


def _row(state: State, first: State, fields: list[str]) -> np.ndarray:
    if state.joints != first.joints or any(len(state.values[field]) != len(first.joints) for field in fields):
        raise LogError(
            "the messages of the recording do not all name the same joints",
            evidence={"first": list(first.joints[:20]), "later": list(state.joints[:20])},
            remedy="record one publisher of joint states, or export its messages as CSV or Parquet",
        )
    return np.concatenate([state.values[field] for field in fields])
