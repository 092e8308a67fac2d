"""Laws of a joint that its drive holds: what it shows is noise, and no estimator takes that for motion."""

from functools import cache

import numpy as np
import pytest

from tests.core.estimate.sticking_arm import scene
from tests.core.estimate.worlds import planar_robot, swing, true_parameters
from veritorque.core.dynamics.model import standard_model
from veritorque.core.errors import ExcitationError
from veritorque.core.estimate.methods.registry import ESTIMATORS
from veritorque.core.log.model import JointLog
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.signals.condition import condition
from veritorque.core.signals.recipe import FilterOptions
from veritorque.core.signals.state import MotionState
from veritorque.core.study import IdentifyRequest, identify, identify_with_conflicts

MODEL = standard_model(planar_robot())
TRUE = true_parameters(MODEL)
ENCODER = 1e-5
"""RMS noise of the encoders, rad."""
FILTERS = ("ekf", "srukf")


@cache
def log_of_held(joint: int, noise: float = ENCODER, *, exchanged: bool = False) -> JointLog:
    """Record both joints, one of which stands; the other's friction and motion are known."""
    moving = swing(2, rate_hz=250.0)
    kept = np.arange(2) != joint
    state = MotionState(
        np.where(kept, moving.position, 0.4), moving.velocity * kept, moving.acceleration * kept
    )
    rng = np.random.default_rng(joint)
    position = state.position + noise * rng.normal(size=state.position.shape)
    torque = MODEL.torque(TRUE, state) + 0.02 * rng.normal(size=position.shape)
    torque = torque[:, ::-1] if exchanged else torque
    return log_from_arrays("held", np.arange(len(position)) / 250.0, position, torque)


def identified(log: JointLog, estimator: str) -> dict[str, object]:
    options = {"estimator": estimator, "bootstrap": {"draws": 0}}
    if estimator == "oe":
        options["iteration"] = {"most": 2}
    return identify(IdentifyRequest(MODEL.robot, (log,), options))


@pytest.mark.parametrize("joint", [0, 1])
def test_a_held_joint_has_neither_velocity_nor_acceleration(joint):
    motion = condition(log_of_held(joint), MODEL.robot, FilterOptions())
    assert motion.recipe.held.tolist() == [joint == 0, joint == 1]
    (tile,) = motion.tiles()
    assert not tile.state.velocity[:, joint].any()
    assert not tile.state.acceleration[:, joint].any()
    assert tile.state.velocity[:, 1 - joint].std() > 0.1


def test_a_joint_that_stands_in_the_survey_but_moves_once_keeps_its_motion():
    time = np.arange(0.0, 700.0, 0.02)
    moving = np.sin(2.0 * np.pi * 0.3 * time)
    once = np.where((time > 75.0) & (time < 80.0), 0.2 * (1.0 - np.cos(0.4 * np.pi * (time - 75.0))), 0.0)
    position = np.column_stack([moving, once])
    log = log_from_arrays("once", time, position, position)
    motion = condition(log, MODEL.robot, FilterOptions())
    fastest = max(np.abs(tile.state.velocity[:, 1]).max() for tile in motion.tiles())
    assert fastest == pytest.approx(0.2 * 0.4 * np.pi, rel=0.02)


# The second joint alone shows its friction and offset well; the first one's rows show everything else.
@pytest.mark.parametrize("estimator", [name for name in ESTIMATORS if name not in (*FILTERS, "oe")])
@pytest.mark.parametrize("joint", [0, 1])
def test_every_estimator_finds_the_friction_of_the_joint_that_moves_and_claims_nothing_of_the_other(
    estimator, joint
):
    document = identified(log_of_held(joint), estimator)
    rows = {row["name"]: row for row in document["base_parameters"]}
    moving, held = 2 - joint, joint + 1
    true = {parameter.name: value for parameter, value in zip(MODEL.parameters, TRUE, strict=True)}
    for name in (f"FV{moving}", f"FC{moving}"):
        assert rows[name]["value"] == pytest.approx(true[name], rel=0.03)
    for name in (f"FV{held}", f"FC{held}", f"IA{held}"):
        row = rows.get(name)
        if row is not None and row["standard_deviation"] is not None:
            assert row["standard_deviation"] > 0.5 * abs(row["value"])
    assert all(row["standard_deviation"] != 0.0 for row in rows.values())
    assert document["conflicts"] == []
    assert not any("too noisy" in sentence for sentence in document["doubts"])


@pytest.mark.parametrize("estimator", FILTERS)
def test_a_filter_that_loses_the_robot_says_that_the_motion_is_the_reason(estimator):
    with pytest.raises(ExcitationError, match="does not separate") as refused:
        identified(log_of_held(1), estimator)
    assert "every joint moves" in refused.value.remedy


def test_output_error_that_parameters_are_not_separated_for_is_warned_of():
    document = identified(log_of_held(1), "oe")
    assert document["conflicts"] == []
    assert document["estimation"]["converged"] or any("did not converge" in one for one in document["doubts"])


@pytest.mark.parametrize("joint", [0, 1])
def test_a_joint_that_moves_alone_is_no_reason_to_call_channels_exchanged(joint):
    request = IdentifyRequest(MODEL.robot, (log_of_held(joint),), {"bootstrap": {"draws": 0}})
    _, conflicts = identify_with_conflicts(request, doubted=True)
    assert conflicts.found == ()


def test_channels_that_are_exchanged_are_found_though_one_joint_stands():
    request = IdentifyRequest(MODEL.robot, (log_of_held(1, exchanged=True),), {"bootstrap": {"draws": 0}})
    _, conflicts = identify_with_conflicts(request)
    assert "exchanged" in conflicts.found[0].hypothesis.statement


@pytest.mark.parametrize("solver", ["clarabel", "cvxpy"])
def test_a_log_of_one_joint_of_a_whole_arm_ends_in_an_answer(solver):
    """Deviations do not depend on the last digits of what is left open, in which solvers differ."""
    own = scene("ur10e")
    signals = own.world.signals(())
    position = np.where(np.arange(6) == 1, signals.position, 0.4)
    rate = np.gradient(position, signals.time, axis=0)
    state = MotionState(position, rate, np.gradient(rate, signals.time, axis=0))
    torque = own.model.torque(own.standard, state)
    torque = torque + 1e-3 * torque.std(axis=0) * np.random.default_rng(0).normal(size=torque.shape)
    noisy = position + ENCODER * np.random.default_rng(1).normal(size=position.shape)
    log = log_from_arrays("one", signals.time, noisy, torque)
    request = IdentifyRequest(own.world.arm.robot, (log,), {"bootstrap": {"draws": 0}, "solver": solver})
    rows = {row["name"]: row for row in identify(request)["base_parameters"]}
    assert 0.0 < rows["FV2"]["standard_deviation"] < 0.05 * rows["FV2"]["value"]
