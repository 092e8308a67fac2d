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
    content: bytearray = field(default_factory=bytearray)
    """Float64 of every message's fields, joint by joint; NaN where it lacks a field."""

    def take(self, state: State) -> None:
        """Take the next message."""
        for name in FIELDS:
            values = state.values[name]
            if len(values) != len(self.joints):
                values = np.full(len(self.joints), np.nan)
            elif state.joints != self.joints:
                values = values[[state.joints.index(name) for name in self.joints]]
            self.content.extend(values.tobytes())
        self.stamps.append(state.stamp)

    @property
    def block(self) -> np.ndarray:
        """Give fields by joints by messages."""
        shape = (len(self.stamps), len(FIELDS), len(self.joints))
        return np.ndarray(shape, dtype=np.float64, buffer=self.content).transpose(1, 2, 0)


def _table(states: Iterator[State]) -> MemoryTable:
    """Gather the messages into columns `position.<joint>`, `velocity.<joint>` and `effort.<joint>`.

    Others may publish messages of other joints on the topic: those who give most values are taken.
    """
    publishers: dict[frozenset[str], _Publisher] = {}
    by_order: dict[tuple[str, ...], _Publisher] = {}
    values = 0
    for state in states:
        values += 1 + len(FIELDS) * len(state.joints)
        check_values(values)
        if state.joints not in by_order:
            publisher = publishers.setdefault(frozenset(state.joints), _Publisher(state.joints))
            by_order[state.joints] = publisher
        by_order[state.joints].take(state)
    if not publishers:
        raise LogError("the recording holds no messages", evidence={"messages": 0}, remedy="record a motion")
    chosen = max(publishers.values(), key=lambda publisher: len(publisher.content))
    block = chosen.block
    given = [place for place in range(len(FIELDS)) if not np.isnan(block[place]).all()]
    names = [f"{FIELDS[place]}.{joint}" for place in given for joint in chosen.joints]
    check_columns(names)
    time = (np.array(chosen.stamps, dtype=np.int64) - chosen.stamps[0]) / NANOSECONDS
    columns = dict(zip(names, block[given].reshape(len(names), -1), strict=True))
    return MemoryTable({"time": time} | columns, notes=_passed_over(publishers.values(), chosen))


def _passed_over(publishers: Iterable[_Publisher], chosen: _Publisher) -> tuple[str, ...]:
    """Say which messages are not of the joints that were taken."""
    return tuple(
        f"{len(other.stamps)} message{'s' if len(other.stamps) > 1 else ''} of "
        f"{', '.join(other.joints[:8]) or 'no joint'} passed over"
        for other in publishers
        if other is not chosen
    )[:MOST_NOTES]
