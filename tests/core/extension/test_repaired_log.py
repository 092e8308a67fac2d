"""A repaired log is the log that would have been written, in whatever pieces it is read."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import pytest

from tests.core.estimate.worlds import planar_robot
from veritorque.core.diagnosis.causes.registry import BY_ID
from veritorque.core.diagnosis.causes.repairs import corrects
from veritorque.core.errors import LogError
from veritorque.core.extension.repair import Repair
from veritorque.core.extension.repaired_log import repaired_log
from veritorque.core.log.model import ArraySource, JointLog, whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.model import RobotModel
from veritorque.core.signals.resample import dropped_mask

RATE_HZ, SECONDS, JOINT = 250.0, 8.0, 2
ANGULAR = 2.0 * np.pi * np.array([0.4, 1.1, 2.3])
DELAY, LAG, GAIN, BEND, DRIFT, SLOWNESS = 0.0137, 0.006, -0.2, 0.004, 1.5, 3.0
WAVE, PHASE = 0.05, 0.7
ROUNDING = 1e-9
ALL = (1, 2)


def motion(time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Give position, velocity and torque of two joints, sums of sines."""
    angle = np.multiply.outer(time, ANGULAR) + np.array([0.1, 0.9, 2.0])
    position = np.stack([np.sin(angle) @ [0.7, 0.3, 0.1], np.cos(angle) @ [0.5, 0.4, 0.1]], axis=1)
    velocity = np.stack(
        [np.cos(angle) * ANGULAR @ [0.7, 0.3, 0.1], -np.sin(angle) * ANGULAR @ [0.5, 0.4, 0.1]], axis=1
    )
    return position, velocity, torque(time)


def torque(time: np.ndarray, time_constant: float = 0.0) -> np.ndarray:
    """Give the torque after a first-order filter that has long settled."""
    response = 1.0 / (1.0 + 1j * ANGULAR * time_constant)
    waves = np.exp(1j * np.multiply.outer(time, ANGULAR)) * response
    return np.stack([(waves @ [3.0, 1.0, 0.4]).imag, (waves @ [2.0, -1.0, 0.5]).real], axis=1)


def log_of(time: np.ndarray, position: np.ndarray, effort: np.ndarray, **channels: np.ndarray) -> JointLog:
    return log_from_arrays("made", time, position, effort, **channels)


def even_time() -> np.ndarray:
    return 100.0 + np.arange(int(SECONDS * RATE_HZ)) / RATE_HZ


def on_joint(change: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    effort = torque(even_time())
    effort[:, JOINT - 1] = change(effort[:, JOINT - 1])
    return effort


@dataclass(frozen=True)
class Fault:
    """Hold a spoilt torque, its repair, and how near to the truth the repair has to come (N m, and why)."""

    effort: np.ndarray
    joints: tuple[int, ...]
    numbers: dict[str, float]
    within: float = ROUNDING


def course(time: np.ndarray) -> np.ndarray:
    return (1.0 - np.exp(-(time - 100.0) / SLOWNESS)) / (1.0 - np.exp(-SECONDS / SLOWNESS))


FAULTS = {
    # A spline through 250 rows a second errs by (w h)^4 / 384 of the quickest wave.
    "time_delay": Fault(torque(even_time() - DELAY), ALL, {"delay": DELAY}, 1e-6),
    # The band's filter takes (2.3 / 20)^4 of the quickest wave's rate away: 2e-4 of 0.05 N m and less.
    "torque_filter_lag": Fault(torque(even_time(), LAG), ALL, {"time_constant": LAG, "band_hz": 20.0}, 1e-4),
    "torque_gain": Fault(on_joint(lambda tau: (1.0 + GAIN) * tau), (JOINT,), {"relative_error": GAIN}),
    "torque_gain_nonlinear": Fault(
        on_joint(lambda tau: tau - BEND * tau**3), (JOINT,), {"cubic_coefficient": -BEND}
    ),
    "torque_offset_drift": Fault(
        on_joint(lambda tau: tau + DRIFT * course(even_time())),
        (JOINT,),
        {"total_drift": DRIFT, "time_constant": SLOWNESS, "start": 100.0, "duration": SECONDS},
    ),
}
every_fault = pytest.mark.parametrize("name", FAULTS)


def spoilt(name: str) -> tuple[JointLog, list[Repair]]:
    fault = FAULTS[name]
    position, velocity, _ = motion(even_time())
    log = log_of(even_time(), position, fault.effort, velocity=velocity)
    return log, [Repair(name, fault.joints, "log", "", fault.numbers)]


def mended(log: JointLog, repairs: list[Repair], robot: RobotModel | None = None) -> JointLog:
    return repaired_log(log, robot or planar_robot(), repairs)


def test_every_cause_that_corrects_a_log_is_repaired_here():
    assert {*FAULTS, "encoder_eccentricity"} == {
        name for name, one in BY_ID.items() if corrects(one) == "log"
    }


@every_fault
def test_a_repaired_torque_is_the_one_that_acted_wherever_the_log_can_tell(name):
    log, repairs = spoilt(name)
    found = mended(log, repairs)
    ((start, stop),) = found.segments
    inner = slice(start, stop)
    assert stop - start > 0.9 * log.samples
    rows, truth = whole_rows(found), torque(even_time())
    np.testing.assert_allclose(rows.torque[inner], truth[inner], atol=FAULTS[name].within)
    assert np.isfinite(rows.torque).all()
    before = np.abs(whole_rows(log).torque - truth).max()
    assert before > 100.0 * FAULTS[name].within


@every_fault
def test_a_repair_of_the_torque_leaves_everything_else_as_it_is(name):
    log, repairs = spoilt(name)
    before, after = whole_rows(log), whole_rows(mended(log, repairs))
    for channel in ("time", "position", "velocity"):
        np.testing.assert_array_equal(getattr(before, channel), getattr(after, channel))
    others = [joint - 1 for joint in ALL if joint not in FAULTS[name].joints]
    np.testing.assert_array_equal(before.torque[:, others], after.torque[:, others])


@every_fault
def test_rows_are_the_same_in_whatever_pieces_they_are_read(name):
    log, repairs = spoilt(name)
    found = mended(log, repairs)
    whole = whole_rows(found).torque
    cuts = [0, 1, 300, 301, 1000, found.samples]
    pieces = [found.source.rows(*cut).torque for cut in pairwise(cuts)]
    np.testing.assert_allclose(np.vstack(pieces), whole, atol=1e-5)


@pytest.mark.parametrize("turn", [1, -1], ids=["gain first", "delay first"])
def test_several_faults_of_a_channel_are_undone_in_whatever_order_they_are_listed(turn):
    late = even_time() - DELAY
    effort = torque(late)
    effort[:, JOINT - 1] = (1.0 + GAIN) * effort[:, JOINT - 1] + DRIFT * course(late)
    names = ("torque_gain", "torque_offset_drift", "time_delay")
    repairs = [spoilt(name)[1][0] for name in names][::turn]
    found = mended(log_of(even_time(), motion(even_time())[0], effort), repairs)
    rows = found.source.rows(*found.segments[0])
    np.testing.assert_allclose(rows.torque, torque(rows.time), atol=1e-6)


def test_an_angle_that_errs_once_per_turn_is_right_to_the_square_of_its_error_and_so_is_its_speed():
    time = even_time()
    position, velocity, effort = motion(time)
    reading, speed = position.copy(), velocity.copy()
    reading[:, JOINT - 1] += WAVE * np.sin(position[:, JOINT - 1] + PHASE)
    speed[:, JOINT - 1] *= 1.0 + WAVE * np.cos(position[:, JOINT - 1] + PHASE)
    one = Repair("encoder_eccentricity", (JOINT,), "log", "", {"amplitude": WAVE, "phase": PHASE})
    rows = whole_rows(mended(log_of(time, reading, effort, velocity=speed), [one]))
    assert np.abs(rows.position - position).max() < WAVE**2
    assert np.abs(rows.velocity - velocity).max() < 2.0 * WAVE**2 * np.abs(velocity).max()
    np.testing.assert_array_equal(rows.torque, effort)


def test_nothing_is_corrected_across_a_gap_and_rows_of_unknown_torque_are_left_out():
    time = np.concatenate([even_time(), even_time() + SECONDS + 2.0])
    log = log_of(time, motion(time)[0], torque(time - DELAY))
    found = mended(log, [Repair("time_delay", ALL, "log", "", {"delay": DELAY})])
    lost = int(np.ceil(DELAY * RATE_HZ))
    assert found.segments == tuple((start + lost, stop - lost) for start, stop in log.segments)
    assert len(found.segments) == 2
    for start, stop in found.segments:
        rows = found.source.rows(start, stop)
        np.testing.assert_allclose(rows.torque, torque(rows.time), atol=1e-6)


def test_what_stands_for_a_dropped_sample_still_does():
    time, rng = even_time(), np.random.default_rng(0)
    held = np.maximum.accumulate(np.where(rng.random(len(time)) < 0.05, 0, np.arange(len(time))))
    log = log_of(time, motion(time)[0][held], torque(time - DELAY)[held])
    found = whole_rows(mended(log, [Repair("time_delay", ALL, "log", "", {"delay": DELAY})]))
    lost = dropped_mask(whole_rows(log))
    assert lost.any()
    np.testing.assert_array_equal(dropped_mask(found), lost)
    np.testing.assert_array_equal(found.time, time)
    inner = ~lost & (np.arange(len(time)) > 10) & (np.arange(len(time)) < len(time) - 10)
    np.testing.assert_allclose(found.torque[inner], torque(time)[inner], atol=1e-3)


def test_stamps_that_scatter_are_honoured():
    rng = np.random.default_rng(3)
    time = even_time() + rng.uniform(-0.3, 0.3, len(even_time())) / RATE_HZ
    log = log_of(time, motion(time)[0], torque(time, LAG))
    numbers = {"time_constant": LAG, "band_hz": 20.0}
    found = mended(log, [Repair("torque_filter_lag", ALL, "log", "", numbers)])
    rows = found.source.rows(*found.segments[0])
    np.testing.assert_allclose(rows.torque, torque(rows.time), atol=2e-3)


def test_a_drift_is_subtracted_from_a_current_as_from_the_torque_that_it_makes():
    log, repairs = spoilt("torque_offset_drift")
    constant, ratio = 0.05, 100.0
    robot = planar_robot()
    driven = tuple(replace(one, torque_constant=constant, gear_ratio=ratio) for one in robot.joints)
    rows = whole_rows(log)
    logged = replace(rows, torque=None, current=rows.torque / (constant * ratio))
    currents = replace(log, source=ArraySource(logged), channels=("position", "current"))
    found = whole_rows(mended(currents, repairs, replace(robot, joints=driven)))
    assert found.torque is None
    np.testing.assert_allclose(constant * ratio * found.current, torque(even_time()), atol=ROUNDING)


def test_a_bent_channel_ends_at_its_turning_point_where_no_torque_is_so_large():
    position = motion(even_time())[0]
    log = log_of(even_time(), position, 100.0 * torque(even_time()))
    one = Repair("torque_gain_nonlinear", (JOINT,), "log", "", {"cubic_coefficient": -BEND})
    largest = np.abs(whole_rows(mended(log, [one])).torque[:, JOINT - 1]).max()
    assert largest == pytest.approx(1.0 / np.sqrt(3.0 * BEND))


def test_a_log_that_is_too_short_to_be_repaired_is_refused_with_what_it_would_take():
    log, _ = spoilt("time_delay")
    with pytest.raises(LogError, match="more than 5000 samples"):
        mended(log, [Repair("time_delay", ALL, "log", "", {"delay": 10.0})])


def test_a_log_without_a_repair_of_its_own_is_the_same_log():
    log, _ = spoilt("torque_gain")
    assert mended(log, []) is log
    assert mended(log, [Repair("kinematic_error", (2,), "robot", "", {"error": 0.1, "d": 0.1})]) is log
    assert mended(log, [Repair("torque_gain", (2,), "nothing", "", {})]) is log


def test_a_repaired_log_is_not_taken_for_the_file_that_it_came_from():
    log, repairs = spoilt("torque_gain")
    found = mended(replace(log, sha256="abc"), repairs)
    assert (found.name, found.sha256) == ("made, repaired", "")
