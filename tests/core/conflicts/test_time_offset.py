"""Torques by another clock than the positions' are named with the offset, and nothing stands for them."""

import numpy as np
import pytest

from tests.core.estimate.worlds import swing, true_parameters
from veritorque.core.dynamics.model import standard_model
from veritorque.core.log.model import JointLog
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.model import RobotModel
from veritorque.core.study import IdentifyRequest, diagnose, identify

PLAIN = {"bootstrap": {"draws": 0}}


@pytest.fixture(scope="module")
def robot() -> RobotModel:
    """Give three skew joints."""
    row = {"type": "revolute", "theta_offset": 0.0}
    rows = [
        {**row, "alpha": 0.0, "d": 0.0, "r": 0.3},
        {**row, "alpha": -np.pi / 2, "d": 0.1, "r": 0.0},
        {**row, "alpha": 0.0, "d": 0.4, "r": 0.1},
    ]
    return robot_from_description({"name": "arm", "joints": rows})


def _log(robot: RobotModel, late: float) -> JointLog:
    """Log torques with 1 % of noise that come some seconds late."""
    model = standard_model(robot)
    state = swing(3, seed=5)
    torque = model.torque(true_parameters(model, seed=3), state)
    torque += 0.01 * torque.std(axis=0) * np.random.default_rng(8).normal(size=torque.shape)
    time = np.arange(len(torque)) / 100.0
    inside = (time - late >= 0.0) & (time - late <= time[-1])
    then = np.stack([np.interp(time[inside] - late, time, own) for own in torque.T], axis=1)
    return log_from_arrays("swing", time[inside], state.position[inside], then)


@pytest.mark.parametrize("late", [-0.5, -0.12, 0.2, 1.0])
def test_the_offset_is_named_with_its_size(robot, late):
    [row] = identify(IdentifyRequest(robot, (_log(robot, late),), PLAIN))["conflicts"]
    assert (row["conflict"], row["channel"], row["applied"]) == ("time_offset", "torque", False)
    assert ("after" if late > 0.0 else "before") in row["statement"]
    said = float(row["statement"].partition("about ")[2].partition(" s ")[0])
    assert said == pytest.approx(abs(late), abs=0.02)
    assert row["error_after_percent"] < 0.5 * row["error_before_percent"]


def test_a_log_by_one_clock_has_none(robot):
    assert not identify(IdentifyRequest(robot, (_log(robot, 0.0),), PLAIN))["conflicts"]


def test_no_cause_is_named_for_sure_beside_it(robot):
    """A filter of 97 ms was named with certainty for a clock that was 100 ms late."""
    document = diagnose(IdentifyRequest(robot, (_log(robot, 0.1),), PLAIN))
    assert [row["conflict"] for row in document["conflicts"]] == ["time_offset"]
    assert all(one["confidence"] <= 0.5 for one in document["diagnosis"]["findings"])
