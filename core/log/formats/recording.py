"""Read the joint states of ROS recordings: MCAP files and SQLite bags of ROS 2, and bags of ROS 1.

Only messages of the type sensor_msgs/JointState are decoded, by the definition that is built in: one that a
recording brings along would have to be compiled. Joints keep their names, because their order in a message
says nothing about the robot. Sources: MCAP format specification; ROS bag format 2.0; sensor_msgs/JointState.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import LogError
from .sqlite_bag import sqlite_bag
from .table import MemoryTable, check_columns, check_density, check_values, reading

MCAP_FORM, SQLITE_FORM, BAG_FORM = "MCAP", "SQLite", "ROS bag"
JOINT_STATE = "sensor_msgs/msg/JointState"
NANOSECONDS = 1_000_000_000
FIELDS = ("position", "velocity", "effort")
MOST_NOTES = 5


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


def open_sqlite_bag(path: Path) -> MemoryTable:
    """Read the joint states of a bag of ROS 2 in SQLite.

    Raises
    ------
    LogError
        If the file is damaged or too large, is no bag, or holds no joint states or several topics of them.
    """
    _require_library()
    with reading(SQLITE_FORM, path), sqlite_bag(path) as bag:
        topic = _joint_states(bag.connections)
        return _table(_decode(bag.messages(topic), ros1=False))


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


@dataclass(frozen=True, eq=False)
class _Publisher:
    """Gather the messages that name the same joints."""

    joints: tuple[str, ...]
    """In the order of the first message."""
    stamps: list[int] = field(default_factory=list)
    rows: list[np.ndarray] = field(default_factory=list)
    """Fields by joints of every message; NaN where it lacks a field."""

    def take(self, state: State) -> None:
        """Take the next message."""
        row = np.full((len(FIELDS), len(self.joints)), np.nan)
        order = [state.joints.index(name) for name in self.joints]
        for place, name in enumerate(FIELDS):
            if len(state.values[name]) == len(self.joints):
                row[place] = state.values[name][order]
        self.stamps.append(state.stamp)
        self.rows.append(row)

    @property
    def values(self) -> int:
        """Count the numbers, one for the joint and instant."""
        return len(self.joints) * len(self.rows)


def _table(states: Iterator[State]) -> MemoryTable:
    """Gather the messages into columns `position.<joint>`, `velocity.<joint>` and `effort.<joint>`.

    Others may publish messages of other joints on the topic: those who give most values are taken.
    """
    publishers: dict[frozenset[str], _Publisher] = {}
    values = 0
    for state in states:
        values += 1 + len(FIELDS) * len(state.joints)
        check_values(values)
        publishers.setdefault(frozenset(state.joints), _Publisher(state.joints)).take(state)
    if not publishers:
        raise LogError("the recording holds no messages", evidence={"messages": 0}, remedy="record a motion")
    chosen = max(publishers.values(), key=lambda publisher: publisher.values)
    block = np.array(chosen.rows).transpose(1, 2, 0)
    given = [place for place in range(len(FIELDS)) if not np.isnan(block[place]).all()]
    names = [f"{FIELDS[place]}.{joint}" for place in given for joint in chosen.joints]
    check_columns(names)
    time = (np.array(chosen.stamps, dtype=np.int64) - chosen.stamps[0]) / NANOSECONDS
    columns = dict(zip(names, block[given].reshape(len(names), -1), strict=True))
    return MemoryTable({"time": time} | columns, notes=_passed_over(publishers.values(), chosen))


def _passed_over(publishers: Iterable[_Publisher], chosen: _Publisher) -> tuple[str, ...]:
    """Say which messages are not of the joints that were taken."""
    return tuple(
        f"{len(other.rows)} message{'s' if len(other.rows) > 1 else ''} of "
        f"{', '.join(other.joints[:8]) or 'no joint'} passed over"
        for other in publishers
        if other is not chosen
    )[:MOST_NOTES]
