"""Play in the transmission: the free flight across the gap, and the column where nothing flies."""

import numpy as np
import pytest

from tests.core.dynamics.terms.chains import JOINTS, described_chain
from veritorque.core.dynamics.terms.backlash import Backlash, twist_of
from veritorque.core.dynamics.terms.encoder_error import EncoderOffset
from veritorque.core.signals.state import MotionState


@pytest.mark.parametrize("half_width", [1e-4, 1e-2])
def test_a_load_that_passes_zero_at_a_steady_rate_crosses_the_gap_in_the_time_of_a_cube_root(half_width):
    step, rate = 1e-4, 50.0
    time = np.arange(-0.2, 0.5, step)
    twist = twist_of(rate * time, step, half_width)
    crossing = time[np.argmax(twist >= half_width)]
    assert crossing == pytest.approx((12.0 * half_width / rate) ** (1.0 / 3.0), abs=5.0 * step)


def test_the_twist_never_leaves_the_gap_and_rests_on_the_side_of_the_load():
    rng = np.random.default_rng(0)
    free = 100.0 * np.repeat(rng.choice([-1.0, 1.0], 40), 500)
    twist = twist_of(free, 1e-3, 1e-3)
    assert np.abs(twist).max() == 1e-3
    settled = np.arange(len(free)) % 500 > 300  # a gap of 2 mrad takes 7 ms at 100 rad/s2
    np.testing.assert_array_equal(twist[settled], 1e-3 * np.sign(free[settled]))


def stepped(free: np.ndarray, step: float, half_width: float) -> np.ndarray:
    """Follow the twist sample by sample, whether it flies or rests."""
    out = np.empty(len(free))
    twist, rate = float(np.copysign(half_width, free[0])), 0.0
    for sample, pull in enumerate(free):
        rate += step * pull
        after = twist + step * rate - 0.5 * step * step * pull
        twist = min(max(after, -half_width), half_width)
        rate = rate if twist == after else 0.0
        out[sample] = twist
    return out


@pytest.mark.parametrize("half_width", [1e-4, 3e-3, 0.1, 10.0])
def test_passing_over_the_time_in_contact_changes_nothing(half_width):
    rng = np.random.default_rng(1)
    free = np.repeat(rng.normal(size=80).cumsum(), 7) + 0.3 * rng.normal(size=560)
    free[200:230] = 0.0
    np.testing.assert_array_equal(twist_of(free, 0.01, half_width), stepped(free, 0.01, half_width))


def test_under_a_load_of_one_sign_play_is_a_zero_error():
    described, _ = described_chain(2)
    robot = described.model.robot
    time = np.arange(0.0, 1.0, 0.002)
    phases = np.arange(JOINTS)
    position = 0.05 * np.sin(4.0 * time[:, None] + phases)
    velocity = 0.2 * np.cos(4.0 * time[:, None] + phases)
    state = MotionState(position, velocity, -16.0 * position, time)
    load = described.load(state)
    joint = 1 + next(j for j in range(JOINTS) if np.ptp(np.sign(load[:, j])) == 0)
    (play,) = Backlash(joint, described, 1e-3, 40.0).torques(robot, state)
    (offset,) = EncoderOffset(joint, described).torques(robot, state)
    side = np.sign(load[0, joint - 1])
    # The shift of the play's column is finite, 1e-5 rad.
    np.testing.assert_allclose(play, side * offset, atol=1e-3 * np.abs(offset).max())
