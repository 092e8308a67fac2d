"""Positions on the motors' side of gears are named with their ratios, and the correction reads them."""

import numpy as np
import pytest

from tests.core.estimate.worlds import swing, true_parameters
from veritorque.core.dynamics.model import standard_model
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import read_log
from veritorque.core.robot.description import robot_from_description
from veritorque.core.study import IdentifyRequest, identify

PLAIN = {"bootstrap": {"draws": 0}}
RATIOS = np.array([101.0, 160.0, 51.0])


@pytest.fixture(scope="module")
def robot():
    """Give three skew joints."""
    row = {"type": "revolute", "theta_offset": 0.0}
    rows = [
        {**row, "alpha": 0.0, "d": 0.0, "r": 0.3},
        {**row, "alpha": -np.pi / 2, "d": 0.1, "r": 0.0},
        {**row, "alpha": 0.0, "d": 0.4, "r": 0.1},
    ]
    return robot_from_description({"name": "arm", "joints": rows})


@pytest.fixture
def table(tmp_path, robot):
    """Write a table of motors' angles in rad and of the joints' torques, whose names say no more."""
    model = standard_model(robot)
    state = swing(3, seed=5)
    torque = model.torque(true_parameters(model, seed=3), state)
    noise = 0.01 * np.sqrt(np.mean(torque**2, axis=0)) * np.random.default_rng(8).normal(size=torque.shape)
    time = np.arange(len(torque)) / 100.0
    names = ["t", *(f"q{joint}" for joint in (1, 2, 3)), *(f"tau{joint}" for joint in (1, 2, 3))]
    path = tmp_path / "log.csv"
    rows = np.column_stack([time, state.position * RATIOS, torque + noise])
    np.savetxt(path, rows, delimiter=",", header=",".join(names), comments="", fmt="%.8g")
    return path


@pytest.mark.parametrize("unit", ["rad", "deg"])
def test_motors_angles_are_named_with_their_ratios_and_the_correction_reads_them(table, robot, unit):
    """In degrees they are as large as joints' angles: nothing but the torques tells."""
    columns = {
        "time": {"column": "t", "unit": "s"},
        "position": {"columns": ["q1", "q2", "q3"], "unit": unit},
        "torque": {"columns": ["tau1", "tau2", "tau3"], "unit": "N m"},
    }
    document = identify(IdentifyRequest(robot, (read_log(table, mapping=columns),), PLAIN))
    (found,) = document["conflicts"]
    assert (found["conflict"], found["joints"], found["channel"]) == ("gear_ratio", [1, 2, 3], "position")
    assert found["confidence"] > 0.9
    assert found["applied"]
    mapping = found["correction"]["mapping"]
    again = read_log(table, mapping=mapping)
    motors = np.genfromtxt(table, delimiter=",", skip_header=1)[:, 1:4]
    ratios = np.ptp(motors, axis=0) / np.ptp(whole_rows(again).position, axis=0)
    assert ratios == pytest.approx(RATIOS, rel=0.02)
    assert not identify(IdentifyRequest(robot, (again,), PLAIN))["conflicts"]
