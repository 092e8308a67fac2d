"""An oscillator whose coefficients change follows its equation, and its own free motion exactly."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from veritorque.core.numerics.oscillator import swing

STEP = 0.006


def test_it_follows_its_equation_while_its_coefficients_change():
    time = STEP * np.arange(1000)

    def square(now):
        return (2.0 * np.pi * 12.0) ** 2 / (1.0 + 0.3 * np.sin(np.pi * now))

    def pull(now):
        return 10.0 + 5.0 * np.sin(6.0 * np.pi * now) * np.tanh(now) + np.sin(16.0 * np.pi * now)

    def motion(now, state):
        return [state[1], pull(now) - 4.0 * state[1] - square(now) * state[0]]

    start = [pull(0.0) / square(0.0), 0.0]
    true = solve_ivp(motion, (0.0, 6.0), start, t_eval=time, rtol=1e-8, atol=1e-11).y[0]
    found = swing(pull(time), STEP, square(time), np.full(1000, 2.0))
    assert np.std((found - true)[100:]) < 0.005 * np.std(true)


@pytest.mark.parametrize("decay", [0.0, 3.0, 20.0])
def test_steps_of_any_length_leave_a_free_motion_as_it_is(decay):
    """After a pull has ended, only frequency and decay are left."""
    time, square = 0.01 * np.arange(400), np.full(400, 900.0)
    found = swing(np.where(time < 1.0, 900.0, 0.0), 0.01, square, np.full(400, decay))[110:]
    pulse = np.sqrt(900.0 - decay**2)
    basis = (
        np.exp(-decay * time[110:, None])
        * np.column_stack([np.cos(pulse * time), np.sin(pulse * time)])[110:]
    )
    left = found - basis @ np.linalg.lstsq(basis, found, rcond=None)[0]
    assert np.abs(left).max() < 1e-9 * np.abs(found).max()


def test_more_than_critical_damping_and_more_than_critical_gain_stay_finite():
    ones = np.ones(300)
    assert np.isfinite([swing(ones, 0.01, 100.0 * ones, decay * ones) for decay in (-30.0, 30.0)]).all()
