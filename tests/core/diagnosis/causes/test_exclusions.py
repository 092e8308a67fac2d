"""What robot and motion exclude is never named: sizes that nothing bounds, limits that the motion exceeds."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from tests.core.diagnosis.scenes import Scene, fitter_of
from tests.core.dynamics.terms.motions import swinging
from tests.core.estimate.worlds import true_parameters
from veritorque.core.diagnosis.causes.encoder_eccentricity import EncoderEccentricity
from veritorque.core.diagnosis.causes.encoder_offset import EncoderOffset
from veritorque.core.diagnosis.causes.exclusion import EXCLUSIONS, GENERAL
from veritorque.core.diagnosis.causes.friction_load_dependent import FrictionLoadDependent
from veritorque.core.diagnosis.causes.friction_presliding import FrictionPresliding
from veritorque.core.diagnosis.causes.friction_viscous_nonlinear import FrictionViscousNonlinear
from veritorque.core.diagnosis.causes.guide import guide
from veritorque.core.diagnosis.causes.protocol import FittedCause, Setting
from veritorque.core.diagnosis.causes.registry import BY_ID, CAUSES
from veritorque.core.diagnosis.causes.torque_gain import TorqueGain
from veritorque.core.diagnosis.causes.torque_offset_drift import TorqueOffsetDrift
from veritorque.core.diagnosis.causes.torque_ripple import TorqueRipple
from veritorque.core.diagnosis.causes.torque_saturation import TorqueSaturation
from veritorque.core.diagnosis.dataset.dataset import build_dataset
from veritorque.core.diagnosis.search.hypothesis import ScoredCandidate
from veritorque.core.dynamics.model import standard_model
from veritorque.core.dynamics.prediction import Prediction
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.description import robot_from_description

FORMED = (EncoderOffset(), TorqueGain())


@cache
def scene(first: float) -> Scene:
    """Look at an arm whose first axis is this much from the vertical, rad; the torque is noisy."""
    row = {"type": "revolute", "theta_offset": 0.0}
    joints = [
        {**row, "alpha": first, "d": 0.0, "r": 0.2},
        {**row, "alpha": -1.3, "d": 0.1, "r": 0.05},
        {**row, "alpha": 1.1, "d": 0.3, "r": 0.1},
    ]
    model = standard_model(robot_from_description({"name": "arm", "joints": joints}))
    state, truth = swinging(3, 15.0), true_parameters(model)
    torque = model.torque(truth, state) + 0.05 * np.random.default_rng(6).normal(size=state.position.shape)
    log = log_from_arrays("arm", np.asarray(state.time), state.position, torque)
    dataset = build_dataset(model, (log,), held_out=frozenset({(0, 4)}), blocks=5)
    return Scene(dataset, Prediction(model, truth))


@cache
def scans(first: float) -> dict[tuple[str, tuple[int, ...]], ScoredCandidate]:
    fitter = fitter_of(scene(first), FORMED)
    return {scored.candidate.key: scored for scored in fitter.scan(fitter.fit(()))}


def test_the_zero_of_a_vertical_first_joint_cannot_be_shown_by_rounding_errors():
    """It moves no torque at all: what is left of its columns is what 64 bits round."""
    upright = scans(0.0)["encoder_offset", (1,)]
    assert not upright.determined


def test_the_zeros_of_joints_that_gravity_turns_can_be_shown():
    for key in (("encoder_offset", (1,)), ("encoder_offset", (2,))):
        assert scans(0.4)[key].identifiable
    assert scans(0.0)["encoder_offset", (2,)].identifiable


def test_a_gain_can_be_shown_where_other_joints_know_the_load():
    assert scans(0.4)["torque_gain", (2,)].identifiable


@pytest.mark.parametrize(
    ("share", "excluded"), [(0.6, True), (0.75, True), (0.9, False), (0.98, False), (1.1, True)]
)
def test_a_limit_that_the_motion_exceeds_or_the_log_never_reaches_is_none(share, excluded):
    look = scene(0.4)
    applied = look.operating_point.applied(look.dataset.state)[:, 1]
    limit = share * float(np.abs(applied).max())
    solved = FittedCause((2,), np.array([1.0, 0.0]), np.eye(2), {"limit": limit}, {})
    at = Setting(look.dataset, look.operating_point, (2,), {"limit": limit})
    assert TorqueSaturation().contradicted(at, solved) is excluded


def test_no_disc_is_as_eccentric_as_its_first_order_cannot_say():
    def solved(amplitude: float) -> FittedCause:
        return FittedCause((1,), np.array([0.0, amplitude]), 1e-6 * np.eye(2), {}, {})

    assert EncoderEccentricity().admissible(solved(0.27))
    assert not EncoderEccentricity().admissible(solved(0.31))
    look = scene(0.4)
    at = Setting(look.dataset, look.operating_point, (1,), {})
    assert not EncoderEccentricity().represented(at, solved(0.27))
    assert EncoderEccentricity().represented(at, solved(0.1))


@pytest.mark.parametrize(("exponent", "sure"), [(0.12, False), (0.18, False), (0.4, True), (2.0, True)])
def test_friction_that_differs_from_coulomb_friction_next_to_reversals_only_is_doubtful(exponent, sure):
    solved = FittedCause((1,), np.ones(1), 1e-6 * np.eye(1), {"exponent": exponent}, {})
    assert FrictionViscousNonlinear().admissible(solved)
    look = scene(0.4)
    at = Setting(look.dataset, look.operating_point, (1,), solved.scalars)
    assert FrictionViscousNonlinear().represented(at, solved) is sure


@pytest.mark.parametrize(
    ("exponent", "deviation", "sure"),
    [
        *((1.1, 0.21, False), (0.74, 0.14, False), (0.74, 0.1, True), (1.7, 0.3, True), (2.5, 0.8, False)),
        *((0.26, 0.2, False), (0.26, 0.1, True), (0.4, 0.07, True)),
    ],
)
def test_friction_that_may_as_well_be_linear_or_coulombs_is_doubtful(exponent, deviation, sure):
    solved = FittedCause((1,), np.ones(1), np.eye(1), {"exponent": exponent}, {"exponent": deviation})
    look = scene(0.4)
    at = Setting(look.dataset, look.operating_point, (1,), solved.scalars)
    assert FrictionViscousNonlinear().represented(at, solved) is sure


@pytest.mark.parametrize(("coefficient", "sure"), [(0.07, True), (0.3, True), (0.6, False)])
def test_a_gear_that_would_lock_itself_is_doubtful(coefficient, sure):
    solved = FittedCause((1,), np.array([coefficient]), 1e-6 * np.eye(1), {}, {})
    look = scene(0.4)
    at = Setting(look.dataset, look.operating_point, (1,), {})
    assert FrictionLoadDependent().admissible(solved)
    assert FrictionLoadDependent().represented(at, solved) is sure


@pytest.mark.parametrize(("deviation", "sure"), [(0.1, True), (0.3, True), (0.4, False), (1.2, False)])
def test_a_presliding_level_that_may_as_well_be_coulomb_friction_is_doubtful(deviation, sure):
    look = scene(0.4)
    at = Setting(look.dataset, look.operating_point, (1,), {"presliding_distance": 2e-3})
    solved = FittedCause((1,), np.ones(1), deviation**2 * np.eye(1), dict(at.scalars), {})
    assert FrictionPresliding().represented(at, solved) is sure


@pytest.mark.parametrize(("time_constant", "sure"), [(0.7, False), (2.9, False), (3.5, True), (600.0, True)])
def test_an_offset_that_has_settled_within_seconds_is_doubtful(time_constant, sure):
    look = scene(0.4)
    at = Setting(look.dataset, look.operating_point, (1,), {"time_constant": time_constant})
    solved = FittedCause((1,), np.ones(1), 1e-6 * np.eye(1), dict(at.scalars), {})
    assert TorqueOffsetDrift().represented(at, solved) is sure


@pytest.mark.parametrize(
    "cause", [one for one in CAUSES if np.isfinite(one.traits.largest)], ids=lambda cause: cause.id
)
def test_a_size_that_is_admissible_is_no_larger_than_the_largest(cause):
    """Or a log that leaves a cause open beyond what it may be would still be said to show it."""
    width = 2 if cause.id in ("gravity_misalignment", "encoder_eccentricity") else 1
    site = () if cause.id in ("gravity_misalignment", "time_delay", "torque_filter_lag") else (1,)

    def solved(size: float) -> FittedCause:
        values = np.zeros(width)
        values[0] = size
        return FittedCause(site, values, 1e-9 * np.eye(width), {"entry": 0.0, "around": size}, {})

    assert cause.admissible(solved(0.9 * cause.traits.largest))
    assert not cause.admissible(solved(1.1 * cause.traits.largest))


def test_the_list_of_exclusions_is_of_known_causes_and_stands_in_the_guide():
    page = guide()
    assert all(entry.cause in BY_ID for entry in EXCLUSIONS)
    assert all(entry.where in page and entry.law in page for entry in EXCLUSIONS)
    assert all(f"- {law}" in page for law in GENERAL)


@pytest.mark.parametrize(
    ("harmonic", "deviation", "range_rad", "sure"),
    [(2.5, 0.1, 3.0, False), (6.0, 0.1, 3.0, True), (6.0, 0.1, 1.2, False), (2.2, 0.2, 6.0, False)],
    ids=["little more than a wave", "three waves", "a small range", "as slow as the slowest"],
)
def test_a_ripple_of_which_the_motion_shows_little_more_than_a_wave_is_doubtful(
    harmonic, deviation, range_rad, sure
):
    look = scene(0.4)
    state = look.dataset.state
    position = state.position * range_rad / np.ptp(state.position[:, 1])
    dataset = replace(look.dataset, state=replace(state, position=position))
    at = Setting(dataset, look.operating_point, (2,), {"harmonic": harmonic, "centre": 0.0})
    solved = FittedCause((2,), np.ones(2), 1e-6 * np.eye(2), dict(at.scalars), {"harmonic": deviation})
    assert TorqueRipple().represented(at, solved) is sure
