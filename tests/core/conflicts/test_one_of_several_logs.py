"""What is wrong with one of several logs is said of that log, and its correction reads that one anew."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from tests.core.estimate.worlds import swing, true_parameters
from veritorque.core.dynamics.model import standard_model
from veritorque.core.log.model import JointLog, LogRows, whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.model import RobotModel
from veritorque.core.study import IdentifyRequest, identify

PLAIN = {"bootstrap": {"draws": 0}}


def _changed(log: JointLog, change: Callable[[LogRows], None]) -> JointLog:
    """Change the arrays of a log, as its recorder might have."""
    rows = whole_rows(log)
    rows = replace(rows, position=rows.position.copy(), torque=rows.torque.copy())
    change(rows)
    return log_from_arrays(log.name, rows.time, rows.position, rows.torque)


def _reverse(rows: LogRows) -> None:
    rows.torque[:, 1] *= -1.0


def _enlarge(rows: LogRows) -> None:
    rows.torque[:, 1] *= 1000.0


def _turn(rows: LogRows) -> None:
    rows.position[:, 1] += 0.96


def _replace(rows: LogRows) -> None:
    rows.torque[:, 1] = np.gradient(rows.position[:, 1], rows.time)


SPOILT = {"torque_sign": _reverse, "unit": _enlarge, "zero_offset": _turn, "other_signal": _replace}


@pytest.fixture(scope="module")
def arm() -> RobotModel:
    """Give three skew joints."""
    row = {"type": "revolute", "theta_offset": 0.0}
    rows = [
        {**row, "alpha": 0.0, "d": 0.0, "r": 0.3},
        {**row, "alpha": -np.pi / 2, "d": 0.1, "r": 0.0},
        {**row, "alpha": 0.0, "d": 0.4, "r": 0.1},
    ]
    return robot_from_description({"name": "arm", "joints": rows})


def _log(arm: RobotModel, seed: int) -> JointLog:
    """Log another motion of the same arm, with 1 % of noise."""
    model = standard_model(arm)
    state = swing(3, seed=seed)
    torque = model.torque(true_parameters(model, seed=3), state)
    torque += 0.01 * torque.std(axis=0) * np.random.default_rng(seed).normal(size=torque.shape)
    return log_from_arrays(f"log {seed}", np.arange(len(torque)) / 100.0, state.position, torque)


@pytest.mark.parametrize("conflict", sorted(SPOILT))
def test_it_is_said_of_the_log_that_is_spoilt(arm, conflict):
    """Reversed in all logs, the torque of a joint fitted one log and failed on the sound ones."""
    logs = (_log(arm, 5), _changed(_log(arm, 6), SPOILT[conflict]))
    document = identify(IdentifyRequest(arm, logs, PLAIN))
    [row] = document["conflicts"]
    assert (row["conflict"], row["joints"], row["applied"]) == (conflict, [2], False)
    assert "in log 6 alone" in row["statement"]
    sound, corrected = row["correction"]["mappings"]
    assert "scale" not in sound["torque"]
    assert "offset" not in sound["position"]
    assert corrected != sound


def test_nothing_is_said_of_sound_logs(arm):
    assert not identify(IdentifyRequest(arm, (_log(arm, 5), _log(arm, 6)), PLAIN))["conflicts"]


def test_a_log_that_is_held_out_as_a_whole_decides_nothing(arm):
    logs = (_log(arm, 5), _changed(_log(arm, 6), _reverse), _log(arm, 7))
    document = identify(IdentifyRequest(arm, logs, PLAIN | {"validation": {"logs": [2]}}))
    assert not document["conflicts"]
