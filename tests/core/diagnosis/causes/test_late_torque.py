"""A delayed torque is found at its own delay, however large: the part that a fit absorbs must not hide it."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.signal import lfilter

from tests.core.diagnosis.scenes import ARM_RATE_HZ, measured_arm, skew_arm
from tests.core.diagnosis.test_diagnose import asked
from tests.core.estimate.worlds import true_parameters
from veritorque.core.diagnosis.diagnose import diagnose
from veritorque.core.dynamics.model import standard_model
from veritorque.core.dynamics.terms.torque_filter_lag import filter_first_order

NEARLY_A_WALK = 0.995
"""Share of a sample's noise in the next one."""


def ideal_torque(state):
    model = standard_model(skew_arm())
    return model.torque(true_parameters(model), state)


def drifting_noise(shape):
    """Give noise with a correlation time of nearly a second, 1 N m RMS."""
    drawn = np.random.default_rng(11).normal(size=shape) * np.sqrt(1.0 - NEARLY_A_WALK**2)
    return lfilter([1.0], [1.0, -NEARLY_A_WALK], drawn, axis=0)


def filtered(time_constant):
    def effect(state):
        torque = ideal_torque(state)
        return (
            filter_first_order(torque, 1.0 / ARM_RATE_HZ, time_constant)
            - torque
            + drifting_noise(torque.shape)
        )

    return effect


def delayed(delay):
    def effect(state):
        torque = ideal_torque(state)
        then = np.clip(state.time - delay, state.time[0], state.time[-1])
        return CubicSpline(state.time, torque)(then) - torque + drifting_noise(torque.shape)

    return effect


@pytest.mark.slow
@pytest.mark.parametrize("time_constant", [0.012, 0.02, 0.04])
def test_a_filter_is_found_at_its_time_constant(time_constant):
    (found,) = diagnose(asked(measured_arm(filtered(time_constant), seconds=12.0))).findings
    assert found.cause == "torque_filter_lag"
    (size,) = found.quantities
    assert abs(size.value - time_constant) < 3.0 * size.standard_deviation


@pytest.mark.slow
@pytest.mark.parametrize("delay", [-0.012, 0.012, 0.03])
def test_a_delay_is_found_at_its_length(delay):
    (found,) = diagnose(asked(measured_arm(delayed(delay)))).findings
    assert found.cause == "time_delay"
    (size,) = found.quantities
    assert abs(size.value - delay) < 3.0 * size.standard_deviation
