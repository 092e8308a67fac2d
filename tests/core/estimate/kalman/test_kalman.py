"""What Kalman filters are for: noisy encoders, joints that stick, and parameters that change over time."""

from functools import cache

import numpy as np
import pytest

from tests.core.estimate.sticking_arm import scene
from tests.core.estimate.worlds import planar_robot, swing, true_parameters
from veritorque.core.dynamics.model import standard_model
from veritorque.core.errors import OptionError
from veritorque.core.identification.options import parse_options
from veritorque.core.identification.result import Identification
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.reduction.base import base_model
from veritorque.core.study import IdentifyRequest, identify_in_full

BOTH = pytest.mark.parametrize("estimator", ["ekf", "srukf"])
QUIET, DRIFT = 0.02, 0.1


@cache
def fitted(encoder_deg: float, estimator: str, draws: int = 0) -> Identification:
    """Fit an arm of two joints that stick; several laws look at the same fit."""
    own = scene("planar-2")
    asked = {"bootstrap": {"draws": draws}, "estimator": estimator}
    return identify_in_full(IdentifyRequest(own.world.arm.robot, (own.log(encoder_deg, QUIET, 0),), asked))


@BOTH
def test_a_filter_predicts_torque_where_joints_stick_and_encoders_are_noisy(estimator):
    own = scene("planar-2")
    assert own.error(fitted(1e-3, estimator).estimate.base) < 0.06
    least, filtered = (fitted(1e-1, name) for name in ("sdp", estimator))
    assert own.error(filtered.estimate.base) < 0.5 * own.error(least.estimate.base)


@BOTH
def test_a_filter_foresees_positions_as_well_as_it_expects(estimator):
    found = fitted(1e-2, estimator)
    np.testing.assert_allclose(found.innovations.variance, 1.0, atol=0.1)
    np.testing.assert_allclose(found.innovations.position_noise, np.deg2rad(1e-2), rtol=0.05)
    assert found.innovations.shortened == 0.0


def test_deviations_hold_what_blocks_scatter_and_bootstrap_draws_agree():
    found = fitted(1e-1, "ekf", draws=60)
    ratio = found.draws.std(axis=0) / found.precision.standard_deviation
    assert 0.5 < np.median(ratio) < 2.0
    np.testing.assert_allclose(
        np.diag(found.precision.covariance) / np.diag(found.precision.bread),
        found.innovations.dispersion,
        rtol=0.2,
    )


def drifting(growth: float) -> Identification:
    """Follow two links whose first joint's viscous friction grows by a share in 10 s."""
    model = standard_model(planar_robot())
    truth, state = true_parameters(model), swing(2, rate_hz=1000.0, seconds=10.0)
    time = np.arange(len(state.position)) / 1000.0
    rng = np.random.default_rng(4)
    place = [parameter.name for parameter in model.parameters].index("FV1")
    torque = model.torque(truth, state) + 0.02 * rng.normal(size=state.position.shape)
    torque[:, 0] += growth * time / time[-1] * truth[place] * state.velocity[:, 0]
    position = state.position + 2e-5 * rng.normal(size=torque.shape)
    log = log_from_arrays("drifting", time, position, torque)
    asked = {"estimator": "ekf", "kalman": {"drift": DRIFT}, "bootstrap": {"draws": 0}}
    return identify_in_full(IdentifyRequest(planar_robot(), (log,), asked))


@pytest.mark.parametrize("growth", [0.0, 1.0])
def test_a_friction_that_drifts_is_followed_and_one_that_does_not_agrees_with_the_estimate(growth):
    model = standard_model(planar_robot())
    found = drifting(growth)
    track, place = found.track, found.base.names.index("FV1")
    truth = base_model(model).base_of(true_parameters(model))[place] * (1.0 + growth * track.time / 10.0)
    assert np.sqrt(np.mean((track.value[2:, place] / truth[2:] - 1.0) ** 2)) < 0.1
    assert (abs(found.estimate.base[place] / truth[-1] - 1.0) > 0.2) == (growth > 0.0)
    if growth == 0.0:
        spread = np.hypot(track.standard_deviation[-1], found.precision.standard_deviation)
        assert np.all(np.abs(track.value[-1] - found.estimate.base) < 4.0 * spread)


def test_parameters_are_followed_only_where_they_may_drift():
    assert fitted(1e-2, "ekf").track is None


@pytest.mark.parametrize(
    "kalman", [{"start_scale": 0.0}, {"drift": 2.0}, {"torque_noise": 1e4}, {"guess": 1}]
)
def test_assumptions_that_are_none_are_refused(kalman):
    with pytest.raises(OptionError):
        parse_options({"estimator": "ekf", "kalman": kalman})


def test_assumptions_of_a_filter_are_refused_where_nothing_is_filtered():
    with pytest.raises(OptionError, match="kalman would have no effect"):
        parse_options({"estimator": "sdp", "kalman": {"drift": 0.1}})


def test_a_start_that_loses_the_robot_is_narrowed_and_gives_the_same_answer():
    arm = scene("planar-2")
    log, errors, begun = arm.log(0.1, 0.2, 0), [], []
    for scale in (10.0, 300.0):
        options = {"estimator": "ekf", "bootstrap": {"draws": 0}, "kalman": {"start_scale": scale}}
        found = identify_in_full(IdentifyRequest(arm.world.arm.robot, (log,), options))
        begun.append(found.innovations.start_scale)
        errors.append(arm.error(found.estimate.base))
    assert begun == [10.0, 30.0]
    assert errors[1] == pytest.approx(errors[0], rel=0.1)
