"""Write joint states as ROS does, by the writers of the rosbags library."""

from pathlib import Path

import numpy as np
from rosbags.rosbag1 import Writer as BagWriter
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Ros2Writer
from rosbags.typesys import Stores, get_typestore

JOINT_STATE = "sensor_msgs/msg/JointState"
START = 1_700_000_000 * 10**9


def messages(types, columns, joints, *, ros1):
    """Give stamps in ns and messages; `joints` names the columns' joints, in the order of the message."""
    kinds = types.types
    header, time = kinds["std_msgs/msg/Header"], kinds["builtin_interfaces/msg/Time"]
    for row, seconds in enumerate(columns["time"]):
        stamp = START + round(seconds * 1e9)
        sequence = {"seq": row} if ros1 else {}
        values = [
            np.array([columns[f"{prefix}_{joint}"][row] for joint in joints.values()])
            for prefix in ("q", "qd", "tau")
        ]
        at = header(stamp=time(stamp // 10**9, stamp % 10**9), frame_id="", **sequence)
        yield stamp, kinds[JOINT_STATE](at, list(joints), *values)


def write_mcap(folder: Path, columns, joints, *, topics=("/joint_states",)) -> Path:
    return _write_ros2(folder, columns, joints, topics, StoragePlugin.MCAP) / "made.mcap"


def write_sqlite(folder: Path, columns, joints, *, topics=("/joint_states",)) -> Path:
    return _write_ros2(folder, columns, joints, topics, StoragePlugin.SQLITE3) / "made.db3"


def _write_ros2(folder: Path, columns, joints, topics, storage: StoragePlugin) -> Path:
    types = get_typestore(Stores.ROS2_HUMBLE)
    with Ros2Writer(folder / "made", version=9, storage_plugin=storage) as writer:
        for topic in topics:
            connection = writer.add_connection(topic, JOINT_STATE, typestore=types)
            for stamp, message in messages(types, columns, joints, ros1=False):
                writer.write(connection, stamp, types.serialize_cdr(message, JOINT_STATE))
    return folder / "made"


def write_bag(folder: Path, columns, joints, *, topics=("/joint_states",)) -> Path:
    types = get_typestore(Stores.ROS1_NOETIC)
    with BagWriter(folder / "made.bag") as writer:
        for topic in topics:
            connection = writer.add_connection(topic, JOINT_STATE, typestore=types)
            for stamp, message in messages(types, columns, joints, ros1=True):
                writer.write(connection, stamp, types.serialize_ros1(message, JOINT_STATE))
    return folder / "made.bag"
