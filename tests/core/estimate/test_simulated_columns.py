"""What simulated columns are for: arms that stick, and noisy encoders, in an engine that is not ours."""

from functools import cache

import numpy as np
import pytest

from tests.core.estimate.sticking_arm import QUIET, scene
from tests.core.estimate.worlds import planar_robot, swing, true_parameters
from veritorque.core.dynamics.model import standard_model
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.study import IdentifyRequest, identify_in_full

WIDE_HZ = 40.0


def torque_error(
    robot: str, encoder_deg: float, estimator: str, draws: int = 1, cutoff_hz: float | None = None
) -> float:
    """Give the RMS error over draws of noise, %."""
    errors = [error_of(robot, encoder_deg, estimator, seed, cutoff_hz) for seed in range(draws)]
    return float(np.sqrt(np.mean(np.square(errors))))


@cache
def error_of(robot: str, encoder_deg: float, estimator: str, seed: int, cutoff_hz: float | None) -> float:
    """Give the error of one fit, %: several laws compare with the same ones."""
    own, options = scene(robot), {} if cutoff_hz is None else {"filter": {"cutoff_hz": cutoff_hz}}
    return own.error(own.estimated(own.log(encoder_deg, QUIET, seed), estimator, options))


@pytest.mark.parametrize(
    ("robot", "encoder_deg", "share"),
    [("planar-2", 1e-3, 0.3), ("planar-2", 1e-2, 1.0), ("ur10e", 1e-3, 0.3), ("ur10e", 1e-2, 0.7)],
)
def test_simulated_columns_predict_better_than_measured_ones_where_joints_stick(robot, encoder_deg, share):
    least, simulated = (torque_error(robot, encoder_deg, name, draws=3) for name in ("sdp", "didim"))
    assert simulated < min(share * least, 0.3)


@pytest.mark.parametrize(
    ("robot", "estimator"), [("planar-2", "clie"), ("planar-2", "cloe"), ("ur10e", "oe")]
)
def test_simulated_output_predicts_better_than_measured_columns_where_joints_stick(robot, estimator):
    least, output = (torque_error(robot, 1e-2, name, draws=3) for name in ("sdp", estimator))
    assert output < least


def test_simulated_motion_holds_less_of_the_noise_of_a_coarse_encoder_than_any_columns():
    least, columns, output = (torque_error("planar-2", 1e-1, name) for name in ("sdp", "didim", "cloe"))
    assert output < min(0.7 * least, columns)


def test_instruments_remove_most_of_the_bias_of_noisy_columns_in_a_wide_band():
    least, instrumental = (torque_error("planar-2", 1e-2, name, cutoff_hz=WIDE_HZ) for name in ("sdp", "iv"))
    assert least > 2.0
    assert instrumental < 0.5 * least


def test_instruments_do_no_harm_where_the_columns_do_not_err():
    least, instrumental = (torque_error("planar-2", 1e-3, name) for name in ("sdp", "iv"))
    assert instrumental < 1.15 * least


def test_prewhitened_instruments_remove_nearly_all_of_the_bias_of_a_wide_band():
    plain, white = (torque_error("planar-2", 1e-2, name, cutoff_hz=WIDE_HZ) for name in ("iv", "piv"))
    assert white < 0.2 * plain


@pytest.mark.parametrize("robot", ["planar-2", "ur10e"])
def test_prewhitened_instruments_do_no_harm_where_columns_hardly_err(robot):
    plain, white = (torque_error(robot, 1e-3, name) for name in ("iv", "piv"))
    assert white < 1.1 * plain


@pytest.mark.parametrize("estimator", ["didim", "clie", "cloe"])
def test_a_replay_at_a_low_rate_is_not_pulled_to_the_inner_side_of_curves(estimator):
    model = standard_model(planar_robot())
    state = swing(2, seconds=10.0, rate_hz=50.0)
    torque = model.torque(true_parameters(model), state)
    log = log_from_arrays("slow", np.arange(len(torque)) / 50.0, state.position, torque)
    asked = {"estimator": estimator, "bootstrap": {"draws": 0}}
    found = identify_in_full(IdentifyRequest(model.robot, (log,), asked))
    assert found.validation_total_percent < 0.8
