"""A link on a spring moves as its own equation says, whose inertia changes with the posture."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.plant import second
from veritorque.core.dynamics.model import standard_model
from veritorque.core.dynamics.prediction import Prediction
from veritorque.core.dynamics.terms.joint_elasticity import Elasticity
from veritorque.core.signals.state import MotionState

SECONDS, RATE_HZ, RESONANCE_HZ = 3.0, 250.0, 12.0


@pytest.fixture(scope="module")
def arm():
    """Give an arm whose inertia about its first joint doubles with the posture, and what is known of it."""
    coupling, none = 0.55, np.zeros(2)
    weights = second.GRAVITY * np.array([2.0, coupling / second.LINK])
    body = second.Body(1.3, 0.3, coupling, weights, none, none, none)
    model = standard_model(second.robot(), ("rigid_body",))
    known = {
        "ZZ1": body.first,
        "MX1": weights[0] / second.GRAVITY,
        "ZZ2": body.second,
        "MX2": body.coupling / second.LINK,
    }
    standard = np.array([known.get(parameter.name, 0.0) for parameter in model.parameters])
    return body, Prediction(model, standard)


def motor(time):
    """Give angle, rate and acceleration of both motors: the first is quick, the second goes far."""
    time = np.asarray(time)
    size, rate = np.array([0.15, 3.0]), 2.0 * np.pi * np.array([4.0, 0.25])
    angle = np.multiply.outer(time, rate)
    return size * np.sin(angle), size * rate * np.cos(angle), -size * rate**2 * np.sin(angle)


@pytest.mark.parametrize("damping_ratio", [0.02, 0.2])
def test_the_columns_are_what_a_link_of_changing_inertia_adds(arm, damping_ratio):
    """The truth is integrated from the arm's closed equations, to all orders of the lag."""
    body, described = arm
    time = np.arange(round(SECONDS * RATE_HZ)) / RATE_HZ
    state = MotionState(*motor(time), time)
    inertia = np.array([body.mass(angle)[0, 0] for angle in state.position])
    assert inertia.max() > 2.0 * inertia.min()
    angular = 2.0 * np.pi * RESONANCE_HZ
    stiffness, damping = angular**2 * inertia.mean(), 2.0 * damping_ratio * angular * inertia.mean()

    def motion(now, lag):
        angle, rate, bend = motor(now)
        first = np.array([1.0, 0.0])
        needed = body.mass(angle - first * lag[0]) @ bend + body.bias(
            angle - first * lag[0], rate - first * lag[1]
        )
        through = stiffness * lag[0] + damping * lag[1]
        return [lag[1], (needed[0] - through) / body.mass(angle)[0, 0]]

    load = described.load(state)[:, 0]
    solved = solve_ivp(motion, (0.0, SECONDS), [load[0] / stiffness, 0.0], t_eval=time, rtol=1e-7, atol=1e-10)
    true = stiffness * solved.y[0] + damping * solved.y[1] - load
    term = Elasticity(1, described, 100.0, RESONANCE_HZ, damping_ratio)
    found = term.series(second.robot(), state)[0] / stiffness
    inner = slice(25, -25)
    assert np.std(found[inner] - true[inner]) < 0.03 * np.std(true[inner])


def test_a_load_that_drives_its_own_swing_without_bound_leaves_finite_columns(arm):
    """As with degrees taken for rad: speeds are 57 times too large, and no number would hold the swing."""
    described = arm[1]
    time = np.arange(round(20.0 * RATE_HZ)) / RATE_HZ
    position, velocity, acceleration = (180.0 / np.pi * np.array(series) for series in motor(time))
    column = Elasticity(0, described, 5.0, RESONANCE_HZ, 0.02)
    (torques,) = column.torques(second.robot(), MotionState(position, velocity, acceleration, time))
    assert np.isfinite(torques).all()
    assert np.abs(torques).max() < 1e12
