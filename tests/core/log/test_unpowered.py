"""An arm that brakes stop while its drives are off is cut out; one that its drives hold or stop is not."""

import numpy as np
import pytest

from tests.core.log.test_defects import healthy, log_of

NOISE = 0.02 * np.random.default_rng(5).normal(size=(5000, 2))


def stopped(position, first, stop, *, brake=40):
    """Let the joints slow down evenly from a row on and stand; they go on where they stopped."""
    speed = position[first] - position[first - 1]
    went = np.minimum(np.arange(1, stop - first + 1), brake)
    position[stop:] -= position[stop] - position[first]
    position[first:stop] = position[first] + np.outer(went - went**2 / (2.0 * brake), speed)
    position[stop:] += position[stop - 1] - position[first]


@pytest.mark.parametrize("fall", [0.0, 0.004])
@pytest.mark.parametrize("stop", [4400, 5000])
def test_an_arm_that_brakes_stop_is_cut_out_from_the_moment_when_its_drives_go_off(stop, fall):
    time, position, torque = healthy()
    stopped(position, 4000, stop if stop < 5000 else 4999)
    position[-1] = position[-2]
    since = np.maximum(time[4000:stop] - time[4000], 0.0)[:, None]
    last = torque[3999] * (0.0 if fall == 0.0 else np.exp(-since / fall))
    torque[4000:stop] = last + NOISE[4000:stop]
    log = log_of(time, position, torque)
    (found,) = [defect for defect in log.defects if defect.kind == "unpowered"]
    assert found.joint is None
    assert log.segments[0][0] == 0
    assert 3990 <= log.segments[0][1] <= 4000
    assert [begin >= stop for begin, _ in log.segments[1:]] == [True] * (stop < 5000)


def test_an_arm_that_stood_before_its_drives_went_off_is_a_standstill_only():
    time, position, torque = healthy()
    stopped(position, 3000, 4999)
    position[-1] = position[-2]
    torque[3000:4000] = torque[2999] + NOISE[3000:4000]
    torque[4000:] = NOISE[4000:]
    assert {defect.kind for defect in log_of(time, position, torque).defects} == {"standstill"}


def test_an_arm_that_its_controller_stops_without_a_load_is_a_standstill_only():
    time, position, torque = healthy()
    stopped(position, 4000, 4999)
    position[-1] = position[-2]
    fall = np.clip(1.0 - np.arange(1000) / 40.0, 0.0, 1.0)[:, None]
    torque[4000:] = torque[3999] * fall + NOISE[4000:]
    assert {defect.kind for defect in log_of(time, position, torque).defects} == {"standstill"}


def test_an_arm_that_coasts_is_not_cut():
    time, position, torque = healthy()
    torque[2000:2500] = NOISE[2000:2500]
    assert log_of(time, position, torque).segments == ((0, 5000),)


@pytest.mark.parametrize("rate_hz", [25.0, 50.0, 100.0])
@pytest.mark.parametrize("phase", np.linspace(0.0, 3.0, 7))
def test_a_load_that_passes_zero_where_its_joint_turns_round_is_not_cut(rate_hz, phase):
    """At a low rate it is there four samples before."""
    time = np.arange(0.0, 20.0, 1.0 / rate_hz)
    swing = 0.5 * np.sin(2.0 * np.pi * 0.25 * time) + 0.3 * np.sin(2.0 * np.pi * 0.6 * time + phase)
    log = log_of(time, swing[:, None], np.sin(swing)[:, None])
    assert "unpowered" not in {defect.kind for defect in log.defects}
