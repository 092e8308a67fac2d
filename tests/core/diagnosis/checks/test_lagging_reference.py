"""A reference that is logged as the position shows no presliding friction, nor does that show a reference."""

from functools import cache

import numpy as np
import pytest

from tests.core.diagnosis.scenes import fitter_of, measured_arm
from tests.core.joint_model.plant import Plant, Run, log_of, recorded, robot_of
from veritorque.core.diagnosis.causes.friction_presliding import FrictionPresliding
from veritorque.core.diagnosis.checks.lagging_reference import lagging_reference
from veritorque.core.diagnosis.search.stepwise import search_stepwise
from veritorque.core.diagnosis.thresholds.checks import CONFIDENCE
from veritorque.core.dynamics.terms.friction_presliding import dahl
from veritorque.core.study import IdentifyRequest, diagnose

LOOP_HZ, LEVEL, DISTANCE = 3.0, 6.0, 0.02
"""Bandwidth of the loop; dry friction, N m; and a distance over which friction of another joint builds up."""
SLOW = (2.0 * np.pi * LOOP_HZ) ** 2, 1.4 * 2.0 * np.pi * LOOP_HZ


@cache
def diagnosed(position: str) -> dict:
    """Diagnose a joint with dry friction under its controller, by what the log has for the position."""
    run = Run(
        highest_hz=1.0, seconds=30.0, rate=250.0, noise=1e-6, kp=SLOW[0], kd=SLOW[1], frequencies=12, seed=3
    )
    signals = recorded(Plant(stiffness=None, coulomb=LEVEL), run)
    noise = 0.05 * np.random.default_rng(1).normal(size=len(signals["time"]))
    log = log_of(
        signals | {"position": signals[position], "torque": signals["torque"] + noise}, reference=False
    )
    options = {"bootstrap": {"draws": 0}}
    return dict(diagnose(IdentifyRequest(robot_of(), (log,), options))["diagnosis"])


def test_a_reference_that_is_logged_as_the_position_is_not_called_presliding_friction():
    found = diagnosed("reference")
    assert found["verdict"] == "unexplained"
    assert "check whether the log's positions are the reference" in str(found)
    assert all(each["confidence"] <= CONFIDENCE.doubtful for each in found["findings"])


def test_measured_positions_of_the_same_joint_are_not_taken_for_a_reference():
    assert "are the reference" not in str(diagnosed("position"))


@pytest.mark.parametrize("seed", [6, 7])
def test_friction_that_builds_up_over_a_distance_is_not_taken_for_a_loop(seed):
    def builds_up(state):
        joints = range(state.position.shape[1])
        sides = [(state.position[:, joint], state.velocity[:, joint]) for joint in joints]
        return np.column_stack([dahl(*side, DISTANCE) - np.sign(side[1]) for side in sides])

    found = search_stepwise(fitter_of(measured_arm(builds_up, seed=seed), (FrictionPresliding(),)))
    assert len(found.chosen.members) == 3
    assert lagging_reference(found) is None
