"""Torques without friction are said to look computed, those with a fifth of the usual friction are not."""

import numpy as np
import pytest

from tests.core.estimate.worlds import log_of, planar_robot, swing, true_parameters
from veritorque.core.dynamics.model import standard_model
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.study import IdentifyRequest, identify

MODEL = standard_model(planar_robot())
STATE = swing(2)
NOISE = 1e-3 * np.random.default_rng(4).normal(size=STATE.position.shape)


def doubts(friction: float) -> list[str]:
    """Identify a log whose friction is a share of the usual one."""
    rubs = np.array([one.symbol in {"FV", "FC"} for one in MODEL.parameters])
    parameters = np.where(rubs, friction, 1.0) * true_parameters(MODEL)
    rows = whole_rows(log_of(MODEL, parameters, STATE, NOISE))
    log = log_from_arrays("log", rows.time, rows.position, rows.torque)
    return identify(IdentifyRequest(MODEL.robot, (log,), {"bootstrap": {"draws": 0}}))["doubts"]


def test_torques_without_friction_look_computed():
    assert any(one.startswith("Most joints show no friction") for one in doubts(0.0))


@pytest.mark.parametrize("friction", [0.2, 1.0])
def test_torques_with_friction_do_not(friction):
    assert not any("friction" in one for one in doubts(friction))
