"""Laws of instruments from other periods: the period is found, and noise of positions biases nothing."""

import numpy as np
import pytest

from tests.core.estimate.worlds import planar_robot, true_parameters
from veritorque.core.dynamics.model import standard_model
from veritorque.core.errors import LogError
from veritorque.core.log.model import JointLog
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.reduction.base import base_model
from veritorque.core.regressor.columns import ColumnPlan, dense
from veritorque.core.signals.condition import condition
from veritorque.core.signals.periods import OtherPeriods, other_periods
from veritorque.core.signals.recipe import FilterOptions
from veritorque.core.signals.state import MotionState
from veritorque.core.study import IdentifyRequest, identify, identify_in_full

RATE_HZ = 250.0
MODEL = standard_model(planar_robot())
BASE = base_model(MODEL)
TRUE = true_parameters(MODEL)


def repeated(time: np.ndarray, period: float, seed: int = 2) -> MotionState:
    """Swing both joints by the first twelve harmonics of a period."""
    rng = np.random.default_rng(seed)
    angular = 2.0 * np.pi / period * np.arange(1, 13)[:, None]
    size = rng.uniform(0.2, 0.6, (12, 2)) / angular
    angle = time[:, None, None] * angular + rng.uniform(0.0, 2.0 * np.pi, (12, 2))
    return MotionState(
        (size * np.sin(angle)).sum(axis=1),
        (size * angular * np.cos(angle)).sum(axis=1),
        (-size * angular**2 * np.sin(angle)).sum(axis=1),
    )


def logged(
    seconds: float, period: float, noise: float = 0.0, seed: int = 0, rate_hz: float = RATE_HZ
) -> JointLog:
    """Record the motion with noise of positions (rad) and a little noise of torques."""
    time = np.arange(round(seconds * rate_hz)) / rate_hz
    state, rng = repeated(time, period), np.random.default_rng(seed)
    position = state.position + noise * rng.normal(size=state.position.shape)
    torque = MODEL.torque(TRUE, state) + 0.01 * rng.normal(size=position.shape)
    return log_from_arrays("repeated", time, position, torque)


def found(log: JointLog) -> OtherPeriods:
    """Find the period of a log."""
    return other_periods(condition(log, MODEL.robot, FilterOptions()), MODEL.robot)


@pytest.mark.parametrize(("period", "seconds"), [(4.0, 12.0), (4.0, 9.5), (7.0, 60.0), (5.3, 37.0)])
@pytest.mark.parametrize("noise", [0.0, 1e-3])
def test_the_period_of_a_motion_is_found_to_a_small_part_of_a_sample(period, seconds, noise):
    assert found(logged(seconds, period, noise)).period == pytest.approx(period * RATE_HZ, abs=0.02)


def test_a_period_that_is_no_whole_number_of_samples_is_found():
    for period in (4.0013, 4.0021):
        assert found(logged(60.0, period)).period == pytest.approx(period * RATE_HZ, abs=0.05)


@pytest.mark.parametrize(
    "log",
    [logged(20.0, 20.0), logged(20.0, 11.0), logged(3.0, 30.0)],
    ids=["one period", "less than two", "hardly any motion"],
)
def test_a_motion_that_does_not_repeat_is_refused_with_what_came_nearest(log):
    with pytest.raises(LogError, match="does not repeat") as caught:
        found(log)
    nearest = caught.value.evidence.get("difference_percent")
    assert nearest is None or nearest > 10.0


def test_a_joint_that_does_not_repeat_with_the_others_is_refused_by_its_number():
    log = logged(12.0, 4.0)
    rows = log.source.rows(0, log.samples)
    position = rows.position.copy()
    position[:, 1] = 0.015 * np.sin(2.0 * np.pi * rows.time / 5.3)
    with pytest.raises(LogError, match="some joints do not repeat") as refused:
        found(log_from_arrays("apart", rows.time, position, rows.torque))
    assert refused.value.evidence["joints"] == [2]


def test_the_other_periods_are_their_mean_without_the_own_one():
    log = logged(12.0, 4.0, 1e-3)
    motion = condition(log, MODEL.robot, FilterOptions())
    other = OtherPeriods(motion, 1000.0)
    (own,), (mean,) = motion.tiles(), other.tiles()
    third = own.state.position.reshape(3, 1000, 2)
    np.testing.assert_allclose(mean.state.position[:1000], third[1:].mean(axis=0), atol=1e-12)
    np.testing.assert_allclose(mean.state.position[1000:2000], third[::2].mean(axis=0), atol=1e-12)


def test_instants_that_no_other_period_shows_are_left_out():
    log = logged(10.0, 4.0)  # the third period lasts two seconds only
    motion = condition(log, MODEL.robot, FilterOptions())
    (other,) = OtherPeriods(motion, 1000.0 * 1.5).tiles()  # as if it lasted six
    phase = np.mod(other.time, 6.0)
    shown = phase < 4.0
    assert not other.usable[phase > 4.5].any()
    assert other.usable[shown & (phase > 1.0) & (phase < 3.5)].mean() > 0.8


def errors(log: JointLog, **options: object) -> tuple[float, np.ndarray]:
    """Give the error of the torque on motions that are not in the log, %, and the base parameters."""
    drawn = np.random.default_rng(9).normal(size=(3, 500, 2))
    state = repeated(np.arange(500) / 25.0, 4.0)
    unseen = MotionState(
        drawn[0], drawn[1] * state.velocity.std(axis=0), drawn[2] * state.acceleration.std(axis=0)
    )
    columns = dense(ColumnPlan(MODEL, BASE.kept), unseen)
    asked = {"filter": {"cutoff_hz": 25.0}, "bootstrap": {"draws": 0}, "weigh_reversals": False, **options}
    base = identify_in_full(IdentifyRequest(MODEL.robot, (log,), asked)).estimate.base
    true = BASE.base_of(TRUE)
    return 100.0 * float(np.linalg.norm(columns @ (base - true)) / np.linalg.norm(columns @ true)), base


def test_without_noise_other_periods_give_least_squares():
    log = logged(20.0, 4.0)
    periods = {"estimator": "iv", "simulation": {"from": "periods"}}
    np.testing.assert_allclose(
        errors(log, **periods)[1], errors(log, estimator="sdp")[1], rtol=1e-3, atol=2e-4
    )


def test_noise_of_positions_biases_least_squares_and_not_instruments_of_other_periods():
    logs = [logged(40.0, 4.0, 1e-3, seed) for seed in range(3)]
    least = [errors(log, estimator="sdp")[0] for log in logs]
    spared = [errors(log, estimator="iv", simulation={"from": "periods"})[0] for log in logs]
    assert np.mean(least) > 5.0
    assert np.mean(spared) < 0.5 * np.mean(least)


def test_periods_need_no_model_that_can_be_simulated():
    document = identify(
        IdentifyRequest(
            MODEL.robot,
            (logged(20.0, 4.0, 1e-4),),
            {
                "estimator": "piv",
                "simulation": {"from": "periods"},
                "smooth_coulomb": True,
                "bootstrap": {"draws": 0},
            },
        )
    )
    told = document["estimation"]
    assert told["simulation"]["periods"] == pytest.approx([4.0])
    assert max(told["simulation"]["position_rms"]) < 1e-3
    assert any("repeats every 4 s" in sentence for sentence in told["statements"])
    assert told["converged"]
