import sqlite3
from contextlib import closing

import numpy as np
import pytest

from tests.core.log.writers import swing
from veritorque.core.errors import LogError
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import read_log

pytest.importorskip("rosbags", reason="ROS recordings need the extra 'ros'")
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as McapWriter
from rosbags.typesys import Stores, get_typestore

from tests.core.log.recordings import JOINT_STATE, messages, write_bag, write_mcap, write_sqlite

COLUMNS = swing(seconds=4.0)
COLUMNS |= {f"qd_{joint}": np.gradient(COLUMNS[f"q_{joint}"], COLUMNS["time"]) for joint in (1, 2, 3)}
JOINTS = {"elbow": 3, "shoulder_lift": 2, "shoulder_pan": 1}
"""In the order of the alphabet, as ROS often publishes them; the robot's order is another."""
ORDER = ["shoulder_pan", "shoulder_lift", "elbow"]
WRITERS = pytest.mark.parametrize("write", [write_mcap, write_sqlite, write_bag])


@WRITERS
def test_joint_states_become_the_log_that_was_recorded(write, tmp_path):
    log = read_log(write(tmp_path, COLUMNS, JOINTS), mapping={"profile": "ros-jointstate", "joints": ORDER})
    rows = whole_rows(log)
    np.testing.assert_allclose(rows.time, COLUMNS["time"], atol=1e-9)  # stamps are whole nanoseconds
    for values, prefix in ((rows.position, "q"), (rows.velocity, "qd"), (rows.torque, "tau")):
        np.testing.assert_array_equal(values, np.column_stack([COLUMNS[f"{prefix}_{j}"] for j in (1, 2, 3)]))


@WRITERS
def test_joints_are_never_taken_in_the_order_in_which_they_were_published(write, tmp_path):
    path = write(tmp_path, COLUMNS, JOINTS)
    with pytest.raises(LogError, match="order of the joints is not known"):
        read_log(path, mapping={"profile": "ros-jointstate"})
    with pytest.raises(LogError, match="no column for position") as caught:
        read_log(path)
    assert "position.elbow" in caught.value.evidence["columns"]


def test_messages_that_lack_a_value_are_left_out_and_those_of_others_passed_over(tmp_path):
    """A gripper publishes on the arm's topic, a driver leaves out a field, and another writes NaN for it."""
    types = get_typestore(Stores.ROS2_HUMBLE)
    columns = {name: values.copy() for name, values in COLUMNS.items()}
    columns["tau_2"][400] = np.nan
    arm = [*messages(types, columns, JOINTS, ros1=False)]
    gripper = [*messages(types, COLUMNS, {"finger": 1}, ros1=False)]
    arm[600][1].effort = np.zeros(0)
    arm[700][1].name, *fields = (arm[700][1].name[::-1], *("position", "velocity", "effort"))
    for name in fields:
        setattr(arm[700][1], name, getattr(arm[700][1], name)[::-1].copy())
    with McapWriter(tmp_path / "made", version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        connection = writer.add_connection("/joint_states", JOINT_STATE, typestore=types)
        for pair in zip(gripper, arm, strict=True):
            for stamp, message in pair:
                writer.write(connection, stamp, types.serialize_cdr(message, JOINT_STATE))
    path = tmp_path / "made" / "made.mcap"
    log = read_log(path, mapping={"profile": "ros-jointstate", "joints": ORDER})
    kept = np.delete(np.arange(len(COLUMNS["time"])), [400, 600])
    for values, prefix in ((whole_rows(log).position, "q"), (whole_rows(log).torque, "tau")):
        np.testing.assert_array_equal(
            values, np.column_stack([columns[f"{prefix}_{j}"][kept] for j in (1, 2, 3)])
        )
    assert "1000 messages of finger passed over" in log.defects[0].statement
    assert (log.defects[1].kind, log.defects[1].count) == ("missing_values", 2)


def test_a_definition_that_a_recording_brings_along_is_never_compiled(tmp_path):
    path = write_mcap(tmp_path, COLUMNS, JOINTS)
    whole = path.read_bytes()
    assert b"string[] name\n" in whole
    path.write_bytes(whole.replace(b"string[] name\n", b"import os;x()\n"))
    log = read_log(path, mapping={"profile": "ros-jointstate", "joints": ORDER})
    np.testing.assert_array_equal(whole_rows(log).position[:, 0], COLUMNS["q_1"])


@WRITERS
def test_several_topics_of_joint_states_are_named_and_refused(write, tmp_path):
    with pytest.raises(LogError, match="several topics") as caught:
        read_log(write(tmp_path, COLUMNS, JOINTS, topics=("/left", "/right")))
    assert caught.value.evidence["topics"] == ["/left", "/right"]


@WRITERS
def test_a_recording_without_joint_states_is_refused(write, tmp_path):
    with pytest.raises(LogError, match=r"no joint states|no messages|cannot be read"):
        read_log(write(tmp_path, COLUMNS, JOINTS, topics=()))


@WRITERS
def test_a_recording_cut_short_or_corrupted_is_refused_or_still_a_log(write, tmp_path):
    path = write(tmp_path, COLUMNS, JOINTS)
    whole, random = path.read_bytes(), np.random.default_rng(1)
    refused = 0
    for trial in range(30):
        spoilt = bytearray(whole[: int(random.integers(20, len(whole)))] if trial % 2 else whole)
        if trial % 2 == 0:
            at = int(random.integers(0, len(spoilt) - 64))
            spoilt[at : at + 64] = random.bytes(64)
        path.write_bytes(bytes(spoilt))
        try:
            read_log(path, mapping={"profile": "ros-jointstate", "joints": ORDER})
        except LogError:
            refused += 1
    assert refused >= 15


@pytest.fixture
def sqlite_bag(tmp_path):
    """Write a bag in SQLite, and let a test change it by statements."""
    path = write_sqlite(tmp_path, COLUMNS, JOINTS)

    def changed(*statements):
        with closing(sqlite3.connect(path)) as database, database:
            for statement in statements:
                database.execute(statement)
        return path

    return changed


def test_messages_of_other_topics_are_not_touched_however_large_they_are(sqlite_bag):
    path = sqlite_bag(
        "INSERT INTO topics VALUES (9, '/camera', 'sensor_msgs/msg/Image', 'cdr', '', '')",
        "INSERT INTO messages SELECT NULL, 9, timestamp, zeroblob(3000000) FROM messages LIMIT 3",
    )
    log = read_log(path, mapping={"profile": "ros-jointstate", "joints": ORDER})
    np.testing.assert_array_equal(whole_rows(log).position[:, 0], COLUMNS["q_1"])


@pytest.mark.parametrize(
    ("statement", "cause", "remedy"),
    [
        ("UPDATE topics SET serialization_format = 'protobuf'", "not serialised as CDR", "ros2 bag convert"),
        ("UPDATE messages SET data = x'28b52ffd00'", "compressed one by one", "ros2 bag convert"),
        ("DROP TABLE topics", "no ROS 2 bag", "CSV or Parquet"),
        ("CREATE VIEW more AS SELECT * FROM messages", "no ROS 2 bag", "CSV or Parquet"),
        ("DELETE FROM messages", "no messages", "record a motion"),
    ],
)
def test_a_bag_in_sqlite_that_cannot_be_read_is_refused_with_what_to_do(statement, cause, remedy, sqlite_bag):
    with pytest.raises(LogError, match=cause) as refusal:
        read_log(sqlite_bag(statement))
    assert remedy in refusal.value.remedy


def test_messages_that_a_killed_recorder_left_beside_its_bag_are_not_forgotten(sqlite_bag, tmp_path):
    """The remedy is carried out: SQLite writes them back, and the log is whole."""
    path = sqlite_bag("PRAGMA journal_mode = WAL")
    with closing(sqlite3.connect(path)) as recorder, recorder:
        recorder.execute("UPDATE messages SET timestamp = timestamp + 1")
        recorder.commit()
        killed = tmp_path / "killed.db3"
        killed.write_bytes(path.read_bytes())
        killed.with_name("killed.db3-wal").write_bytes(path.with_name("made.db3-wal").read_bytes())
    with pytest.raises(LogError, match="in a file beside it") as refusal:
        read_log(killed)
    assert "wal_checkpoint" in refusal.value.remedy
    with closing(sqlite3.connect(killed)) as database:
        database.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    assert read_log(killed, mapping={"profile": "ros-jointstate", "joints": ORDER}).joints == 3


def test_a_bag_in_sqlite_is_read_whatever_its_name_says_to_sqlite(sqlite_bag, tmp_path):
    path = sqlite_bag().rename(tmp_path / "50% of #2?mode=rw.db3")
    assert read_log(path, mapping={"profile": "ros-jointstate", "joints": ORDER}).joints == 3
    assert sorted(file.name for file in tmp_path.iterdir()) == [path.name, "made"]


def test_without_the_library_the_refusal_says_what_to_install(tmp_path, monkeypatch):
    path = write_mcap(tmp_path, COLUMNS, JOINTS)
    monkeypatch.setitem(__import__("sys").modules, "rosbags.typesys", None)
    with pytest.raises(LogError, match="not installed") as caught:
        read_log(path)
    assert "veritorque[ros]" in caught.value.remedy
