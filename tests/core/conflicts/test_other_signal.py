"""Hold what is said of a torque channel that holds another signal: no other conflict stands for it."""

from collections.abc import Callable

import numpy as np
import pytest

from tests.core.conflicts.skew_arm import PLAIN, skew_arm, sound_log, table_mapping, write_table
from veritorque.core.log.model import JointLog, LogRows, whole_rows
from veritorque.core.log.reader import log_from_arrays, read_log
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.model import RobotModel
from veritorque.core.setup_check import check_setup
from veritorque.core.study import IdentifyRequest, identify

JOINT = 1
"""The joint, from 0, whose torque is another signal."""
Made = Callable[[LogRows, np.random.Generator], np.ndarray]
COPIES: dict[str, Made] = {
    "its position": lambda rows, _: rows.position[:, JOINT],
    "its position in degrees": lambda rows, _: np.degrees(rows.position[:, JOINT]),
    "another position": lambda rows, _: rows.position[:, 0],
    "its velocity": lambda rows, _: np.gradient(rows.position[:, JOINT], rows.time),
    "another torque": lambda rows, _: rows.torque[:, 2],
    "its magnitude": lambda rows, _: np.abs(rows.torque[:, JOINT]),
}
UNRELATED: dict[str, Made] = {
    "noise": lambda rows, rng: 0.01 * rng.normal(size=len(rows.time)),
    "a temperature": lambda rows, _: np.round(30.0 + 8.0 * (1.0 - np.exp(-rows.time / 10.0)), 1),
    "coloured noise": lambda rows, rng: np.convolve(rng.normal(size=len(rows.time)), np.ones(9) / 9, "same"),
}


@pytest.fixture(scope="module")
def arm() -> tuple[RobotModel, JointLog]:
    """Give the arm and a sound log of it."""
    robot = skew_arm()
    return robot, sound_log(robot)


def _with_torque(log: JointLog, made: Made) -> JointLog:
    rows = whole_rows(log)
    torque = rows.torque.copy()
    torque[:, JOINT] = made(rows, np.random.default_rng(3))
    return log_from_arrays(log.name, rows.time, rows.position, torque)


@pytest.mark.parametrize("signal", sorted(COPIES))
def test_a_torque_that_is_a_copy_is_named_and_left_out(arm, signal):
    robot, log = arm
    document = identify(IdentifyRequest(robot, (_with_torque(log, COPIES[signal]),), PLAIN))
    [row] = document["conflicts"]
    named = [(one["conflict"], one["joints"]) for one in (row, *row["ambiguous_with"])]
    assert ("other_signal", [JOINT + 1]) in named
    assert row["confidence"] > 0.9
    assert row["correction"]["mapping"]["torque"]["scale"][JOINT] == 0.0


@pytest.mark.parametrize("signal", sorted(UNRELATED))
def test_no_factor_is_put_on_what_no_model_predicts(arm, signal):
    """A unit or a gear's ratio was said of such channels, with certainty."""
    robot, log = arm
    document = identify(IdentifyRequest(robot, (_with_torque(log, UNRELATED[signal]),), PLAIN))
    assert {row["conflict"] for row in document["conflicts"]} <= {"other_signal"}
    assert all(row["confidence"] <= 0.5 for row in document["conflicts"])
    if document["conflicts"]:
        assert not document["validation"][JOINT]["samples"]


@pytest.mark.parametrize("value", [0.0, -3.3])
def test_a_torque_that_is_constant_is_not_exchanged_with_another(arm, value):
    """Constant, it fits any joint through its offset; the exchange was named with certainty."""
    robot, log = arm
    spoilt = _with_torque(log, lambda rows, _: np.full(len(rows.time), value))
    document = identify(IdentifyRequest(robot, (spoilt,), PLAIN))
    assert not document["conflicts"]
    assert any("not measured" in doubt for doubt in document["doubts"])


def test_the_correction_leaves_the_torque_out_of_a_file_that_is_read_by_it(arm, tmp_path):
    robot, log = arm
    rows = whole_rows(_with_torque(log, COPIES["its velocity"]))
    path = tmp_path / "log.csv"
    write_table(path, rows.time, rows.position, rows.torque)
    mapping = table_mapping()
    [row] = identify(IdentifyRequest(robot, (read_log(path, mapping=mapping),), PLAIN))["conflicts"]
    again = identify(IdentifyRequest(robot, (read_log(path, mapping=row["correction"]["mapping"]),), PLAIN))
    assert not again["conflicts"]
    assert again["validation"][JOINT]["samples"] == 0
    assert again["validation"][0]["quality"] == "good"


@pytest.mark.parametrize("only", ["drag", "inertia"])
def test_a_joint_that_has_only_drag_or_inertia_is_no_copy(only):
    """With a coefficient of one its torque is its velocity or acceleration, and the model says so."""
    slide = {"type": "prismatic", "d": 0.0, "r": 0.0, "theta_offset": 0.0}
    rows = [{**slide, "alpha": 0.0}, {**slide, "alpha": np.pi / 2}]
    robot = robot_from_description({"name": "table", "joints": rows, "gravity": [0.0, 9.81, 0.0]})
    time, rates = np.arange(0.0, 20.0, 0.004), np.array([1.1, 2.3, 4.1])
    phase = np.outer(time, rates)[:, :, None] + rates[:, None] * [1.0, 2.0]
    position, speed = (0.1 / rates[:, None] * np.sin(phase)).sum(axis=1), (0.1 * np.cos(phase)).sum(axis=1)
    force = speed + 2.0 * np.sign(speed) + 3.0 * np.gradient(speed, time, axis=0)
    force[:, 0] = speed[:, 0] if only == "drag" else np.gradient(speed[:, 0], time)
    noise = 0.01 * force.std(axis=0) * np.random.default_rng(2).normal(size=force.shape)
    log = log_from_arrays("table", time, position, force + noise)
    assert not check_setup(IdentifyRequest(robot, (log,), PLAIN))["conflicts"]


def test_another_conflict_is_as_sure_beside_a_copy_as_alone(arm):
    robot, log = arm
    rows = whole_rows(_with_torque(log, COPIES["its velocity"]))
    torque = rows.torque * [1.0, 1.0, -1.0]
    spoilt = log_from_arrays(log.name, rows.time, rows.position, torque)
    found = identify(IdentifyRequest(robot, (spoilt,), PLAIN))["conflicts"]
    assert [(row["conflict"], row["joints"]) for row in found] == [
        ("other_signal", [2]),
        ("torque_sign", [3]),
    ]
    assert all(row["confidence"] > 0.9 for row in found)


def test_a_push_for_half_a_log_is_no_other_signal(arm):
    robot, log = arm
    rows = whole_rows(log)
    torque = rows.torque.copy()
    torque[rows.time > 0.5 * rows.time[-1], JOINT] += 20.0 * torque[:, JOINT].std()
    pushed = log_from_arrays(log.name, rows.time, rows.position, torque)
    found = identify(IdentifyRequest(robot, (pushed,), PLAIN))["conflicts"]
    assert "other_signal" not in {row["conflict"] for row in found}
