"""Joints that every row of a text names are called so, whatever their order in the message."""

import numpy as np
import pytest

from tests.core.log.writers import swing
from veritorque.core.errors import LogError
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import read_log

COLUMNS = swing(joints=3)
ORDER = {"elbow_joint": 3, "shoulder_lift_joint": 2, "shoulder_pan_joint": 1}
"""Joints in the order of the alphabet, as ROS publishes them, and their numbers along the arm."""
START = 1_700_000_000


def values(joints, row):
    prefixes = ("q", "q", "tau")  # what stands for the velocity is not looked at
    return [f"{COLUMNS[f'{prefix}_{joint}'][row]:.9f}" for prefix in prefixes for joint in joints.values()]


def rostopic(joints):
    places = range(len(joints))
    fields = [
        f"field.{field}{place}" for field in ("name", "position", "velocity", "effort") for place in places
    ]
    yield ",".join(["%time", "field.header.seq", "field.header.frame_id", *fields])
    for row, time in enumerate(COLUMNS["time"]):
        stamp = START * 10**9 + round(time * 1e9)
        yield ",".join([str(stamp), str(row), "base", *joints, *values(joints, row)])


def ros2(joints):
    for row, time in enumerate(COLUMNS["time"]):
        seconds, rest = divmod(round(time * 1e9), 10**9)
        yield ",".join([str(START + seconds), str(rest), "", *joints, *values(joints, row)])


def suggested(path):
    with pytest.raises(LogError) as refusal:
        read_log(path)
    return refusal.value.evidence["suggested_mappings"][0]


@pytest.mark.parametrize("write", [rostopic, ros2])
def test_the_mapping_that_is_suggested_never_takes_the_order_of_a_message(write, tmp_path):
    path = tmp_path / "log.csv"
    path.write_text("\n".join(write(ORDER)))
    log = read_log(path, mapping=suggested(path))
    rows = whole_rows(log)
    for joint in range(3):
        np.testing.assert_allclose(rows.position[:, joint], COLUMNS[f"q_{joint + 1}"], atol=1e-9)
        np.testing.assert_allclose(rows.torque[:, joint], COLUMNS[f"tau_{joint + 1}"], atol=1e-9)
    np.testing.assert_allclose(rows.time - rows.time[0], COLUMNS["time"], atol=1e-6)
    assert "columns named by the joints that every row names" in log.defects[0].statement


def test_a_profile_asks_for_the_order_of_joints_that_the_rows_name(tmp_path):
    path = tmp_path / "log.csv"
    path.write_text("\n".join(rostopic(ORDER)))
    with pytest.raises(LogError, match="order of the joints is not known"):
        read_log(path, mapping={"profile": "rostopic"})
    along = sorted(ORDER, key=ORDER.__getitem__)
    log = read_log(path, mapping={"profile": "rostopic", "joints": along})
    np.testing.assert_allclose(whole_rows(log).position[:, 0], COLUMNS["q_1"], atol=1e-9)


def test_joints_with_numbers_need_no_order(tmp_path):
    path = tmp_path / "log.csv"
    path.write_text("\n".join(ros2({"joint_3": 3, "joint_1": 1, "joint_2": 2})))
    assert suggested(path) == {"profile": "ros-jointstate"}
    log = read_log(path, mapping={"profile": "ros-jointstate"})
    np.testing.assert_allclose(whole_rows(log).position[:, 2], COLUMNS["q_3"], atol=1e-9)


def test_rows_of_two_publishers_are_refused(tmp_path):
    path = tmp_path / "log.csv"
    lines = list(rostopic(ORDER))
    path.write_text("\n".join(lines).replace("elbow_joint", "finger_joint", 7))
    with pytest.raises(LogError, match="name different joints at one place"):
        read_log(path)
