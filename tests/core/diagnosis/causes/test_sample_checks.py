"""Sample checks find a fault of the samples with its size, and nothing in logs without one."""

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

from veritorque.core.diagnosis.causes.dropped_samples import DroppedSamples
from veritorque.core.diagnosis.causes.encoder_quantization import EncoderQuantization
from veritorque.core.diagnosis.causes.sample_check import SampleCheck, SampleFinding
from veritorque.core.diagnosis.causes.timestamp_jitter import TimestampJitter
from veritorque.core.diagnosis.causes.torque_dead_zone import TorqueDeadZone
from veritorque.core.diagnosis.dataset.dataset import Dataset, build_dataset
from veritorque.core.diagnosis.regression.innovation_covariance import fitted_rows, torque_residual
from veritorque.core.dynamics.model import standard_model
from veritorque.core.dynamics.prediction import Prediction
from veritorque.core.log.model import JointLog
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.model import Joint, Link, RobotModel

CHECKS: dict[str, SampleCheck] = {
    one.id: one for one in (TimestampJitter(), DroppedSamples(), EncoderQuantization(), TorqueDeadZone())
}
RATE_HZ, SECONDS = 250.0, 20.0
INERTIA, NOISE = np.array([2.0, 1.0]), 0.05
FINE = 1e-6
STROKES, COARSE = 5, 0.05


def two_wheels() -> RobotModel:
    """Describe two wheels on parallel level axes: each joint is its own inertia, and nothing couples them."""
    links = tuple(Link(f"wheel_{n}", "revolute", 0, n, np.eye(3), np.zeros(3)) for n in (1, 2))
    joints = tuple(Joint(f"wheel_{n}", rotor_inertia=False, friction=()) for n in (1, 2))
    return RobotModel("wheels", links, joints, np.array([0.0, 0.0, -9.81]))


def operating_point() -> Prediction:
    robot = two_wheels()
    bodies = np.zeros((2, 10))
    bodies[:, [0, 3, 5]] = INERTIA[:, None]
    return Prediction(standard_model(robot, ("rigid_body",)), bodies.ravel())


def motion(time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Give position and torque of two wheels that swing at a few tenths of a hertz."""
    rates, phases = np.array([[2.1, 3.3, 5.2], [2.6, 3.9, 4.7]]), np.array([[0.1, 1.0, 2.0], [0.5, 1.7, 3.0]])
    waves = 0.5 * np.sin(rates * time[:, None, None] + phases)
    return waves.sum(axis=2), -INERTIA * (rates**2 * waves).sum(axis=2)


@cache
def recorded(
    jitter: float = 0.0, lost: float = 0.0, step: float = FINE, *, honest: bool = False, seed: int = 7
) -> JointLog:
    """Record the wheels; `honest` stamps are the real sampling instants."""
    rng = np.random.default_rng(seed)
    stamps = np.arange(int(SECONDS * RATE_HZ)) / RATE_HZ
    real = stamps + jitter * rng.normal(size=len(stamps))
    position, torque = motion(real)
    steps = np.array([step, FINE])
    position = steps * np.round(position / steps)
    torque = torque + NOISE * rng.normal(size=torque.shape)
    gone = rng.random(len(stamps)) < lost
    kept = np.maximum.accumulate(np.where(gone, 0, np.arange(len(stamps))))
    return log_from_arrays("wheels", real if honest else stamps, position[kept], torque[kept])


def findings(cause: str, log: JointLog) -> tuple[SampleFinding, ...]:
    held = operating_point()
    return CHECKS[cause].examine(looked_at(log), held)


@cache
def looked_at(log: JointLog) -> Dataset:
    return build_dataset(operating_point().model, (log,), held_out=frozenset(), blocks=5)


@pytest.mark.parametrize("cause", sorted(CHECKS))
def test_nothing_is_found_in_a_log_without_a_fault(cause):
    assert findings(cause, recorded()) == ()


def test_scattered_instants_with_true_stamps_are_no_fault():
    assert findings("timestamp_jitter", recorded(jitter=2e-4, honest=True)) == ()


def test_rounding_is_not_taken_for_scattered_instants():
    assert findings("timestamp_jitter", recorded(step=2e-3)) == ()


def test_lost_rows_are_counted_and_not_taken_for_scattered_instants():
    log = recorded(lost=0.05)
    (found,) = findings("dropped_samples", log)
    (fraction,) = found.quantities
    assert fraction.value == pytest.approx(0.05, abs=4.0 * fraction.standard_deviation)
    assert found.residual_share.max() < 0.01  # they are bridged
    assert findings("timestamp_jitter", log) == ()


@pytest.mark.parametrize("rows", [2, 5])
def test_positions_that_are_held_from_row_to_row_are_not_taken_for_scattered_instants(rows):
    """A recorder asks for positions at a fraction of its rate, and for torques at every row."""
    whole = recorded().source.data
    held = np.arange(len(whole.time)) // rows * rows
    log = log_from_arrays("wheels", whole.time, whole.position[held], whole.torque)
    assert findings("timestamp_jitter", log) == ()


def test_instants_scatter_although_a_robot_stands_for_most_of_the_time():
    """Only rows in which it moves tell that positions are held."""
    whole = recorded(jitter=4e-4).source.data
    ends = np.repeat([[0], [-1]], 4 * len(whole.time), axis=1)
    still = [np.r_[own[ends[0]], own, own[ends[1]]] for own in (whole.position, whole.torque)]
    time = np.arange(len(still[0])) / RATE_HZ
    torque = still[1] + NOISE * np.random.default_rng(2).normal(size=still[1].shape)
    assert findings("timestamp_jitter", log_from_arrays("wheels", time, still[0], torque))


@pytest.mark.parametrize("rows", [3, 15])
def test_every_row_is_counted_that_stands_for_a_lost_one_however_many_follow_each_other(rows):
    whole = recorded().source.data
    kept = np.arange(len(whole.time))
    for first in (1000, 2000, 3000):
        kept[first : first + rows] = first - 1
    (found,) = findings(
        "dropped_samples", log_from_arrays("wheels", whole.time, whole.position[kept], whole.torque[kept])
    )
    assert found.statistic == 3 * rows


@pytest.mark.parametrize("seed", range(4))
def test_rows_that_a_coarse_recorder_repeats_where_the_robot_starts_and_stops_are_not_lost(seed):
    rng = np.random.default_rng(seed)
    time = np.arange(int(SECONDS * RATE_HZ)) / RATE_HZ
    part = (time / SECONDS * STROKES) % 1.0
    stroke = 10.0 * part**3 - 15.0 * part**4 + 6.0 * part**5
    push = (60.0 * part - 180.0 * part**2 + 120.0 * part**3) * (STROKES / SECONDS) ** 2
    forth = np.where((time / SECONDS * STROKES).astype(int) % 2, -1.0, 1.0)
    angle = np.where(forth > 0.0, stroke, 1.0 - stroke)
    torque = (forth * push)[:, None] * INERTIA + rng.normal(size=(len(time), 2)) * 0.1 * COARSE
    position = np.round(angle[:, None] * np.array([1.0, 0.7]) / 4e-4) * 4e-4
    assert findings("dropped_samples", log_from_arrays("wheels", time, position, _coarse(torque))) == ()


def _coarse(torque: np.ndarray) -> np.ndarray:
    return np.asarray(np.round(torque / COARSE) * COARSE)


def test_a_coarse_encoder_is_found_on_its_own_joint_with_its_step():
    (found,) = findings("encoder_quantization", recorded(step=5e-3))
    assert found.site == (1,)
    assert found.quantities[0].value == pytest.approx(5e-3, rel=1e-6)
    assert found.residual_share[0] > 0.8
    assert found.residual_share[1] < 1e-6  # the wheels know nothing of each other


@pytest.mark.parametrize(
    ("cause", "fault"), [("timestamp_jitter", {"jitter": 4e-4}), ("encoder_quantization", {"step": 5e-3})]
)
def test_the_share_of_a_fault_is_its_true_share(cause, fault):
    held = operating_point()
    spoilt, clean = recorded(**fault), recorded()
    (found,) = findings(cause, spoilt)
    really = 1.0 - _mean_square(looked_at(clean), held) / _mean_square(looked_at(spoilt), held)
    np.testing.assert_allclose(found.residual_share, really, atol=0.15)
    assert really.max() > 0.2


@pytest.mark.parametrize("seed", range(8))
def test_the_deviation_of_the_jitter_is_calibrated(seed):
    (found,) = findings("timestamp_jitter", recorded(jitter=2e-4, seed=seed))
    (std,) = found.quantities
    assert abs(std.value - 2e-4) < 3.5 * std.standard_deviation < 5e-5


def _mean_square(dataset: Dataset, held: Prediction) -> np.ndarray:
    left, mask = torque_residual(dataset, held), fitted_rows(dataset)
    return (left**2 * mask).sum(axis=0) / mask.sum(axis=0)


def test_repeats_that_would_hardly_change_the_residual_are_no_finding_however_sure_they_are():
    # The same rows repeat, as surely by no chance; only the torque's noise is larger.
    log = recorded(lost=0.002)
    rows = log.source.data
    repeats = np.all(np.diff(rows.position, axis=0, prepend=np.nan) == 0.0, axis=1)
    noise = 2000.0 * NOISE * np.random.default_rng(3).normal(size=rows.torque.shape)
    kept = np.maximum.accumulate(np.where(repeats, 0, np.arange(len(repeats))))
    loud = log_from_arrays("wheels", rows.time, rows.position, (rows.torque + noise)[kept])
    assert findings("dropped_samples", loud) == ()
    (found,) = findings("dropped_samples", log)
    assert found.statistic > 5


@pytest.mark.parametrize("lost", [0.002, 0.05])
def test_what_repeats_are_worth_is_what_keeping_them_would_add(lost):
    # Against the same log read as if no row repeated: a tiny scatter of positions hides the repeats.
    log = recorded(lost=lost)
    (found,) = findings("dropped_samples", log)
    rows = log.source.data
    hidden = rows.position + 1e-9 * np.random.default_rng(5).normal(size=rows.position.shape)
    kept = log_from_arrays("wheels", rows.time, hidden, rows.torque)

    def left(one: JointLog) -> np.ndarray:
        data = looked_at(one)
        return np.mean(torque_residual(data, operating_point()) ** 2, axis=0, where=fitted_rows(data))

    more = float(np.max(np.sqrt(left(kept) / left(log)) - 1.0))
    said = float(found.statement.split("would leave ")[1].split(" %")[0]) / 100.0
    assert said == pytest.approx(more, rel=0.5)


def with_torque(change: Callable[[np.ndarray], np.ndarray]) -> JointLog:
    """Record the wheels with another first torque."""
    rows = recorded().source.data
    torque = rows.torque.copy()
    torque[:, 0] = change(torque[:, 0])
    return log_from_arrays("wheels", rows.time, rows.position, torque)


DEAD = 0.6
ZONES: dict[str, tuple[Callable[[np.ndarray], np.ndarray], float]] = {
    "too little by as much": (lambda tau: np.sign(tau) * np.maximum(np.abs(tau) - DEAD, 0.0), 0.2 * DEAD),
    "what they are": (lambda tau: np.where(np.abs(tau) < DEAD, 0.0, tau), 0.02 * DEAD),
}


@pytest.mark.parametrize("words", ZONES)
def test_a_dead_zone_is_found_on_its_channel_with_its_width_and_what_it_does_to_larger_torques(words):
    change, within = ZONES[words]
    spoilt = with_torque(change)
    (found,) = findings("torque_dead_zone", spoilt)
    assert found.site == (1,)
    assert found.quantities[0].value == pytest.approx(DEAD, abs=within)
    assert found.quantities[0].standard_deviation > 0.0
    assert words in found.statement
    held = operating_point()
    really = 1.0 - _mean_square(looked_at(recorded()), held) / _mean_square(looked_at(spoilt), held)
    np.testing.assert_allclose(found.residual_share, really, atol=0.1)
    assert really[0] > 0.15


ZEROS: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "rounded to steps": lambda tau: DEAD * np.round(tau / DEAD),
    "cut off to steps": lambda tau: DEAD * np.trunc(tau / DEAD),
    "missing": lambda tau: np.where(np.arange(len(tau)) % 50 < 3, 0.0, tau),
}


def test_a_dead_zone_of_rounded_torques_is_known_no_better_than_they_are_dense():
    def rounded(torque: np.ndarray) -> np.ndarray:
        return np.where(np.abs(torque) < DEAD, 0.0, np.round(torque, 2))

    (found,) = findings("torque_dead_zone", with_torque(rounded))
    (size,) = found.quantities
    assert abs(size.value - DEAD) < 3.0 * size.standard_deviation < 0.05 * DEAD


@pytest.mark.parametrize("how", ZEROS)
def test_zeros_of_a_coarse_channel_or_of_a_recorder_that_missed_samples_are_no_dead_zone(how):
    assert findings("torque_dead_zone", with_torque(ZEROS[how])) == ()
