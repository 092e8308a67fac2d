"""A compliant gear swings as its link's inertia does: as a lumped spring at rest, and along a motion."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

from core.diagnosis.causes.joint_elasticity import JointElasticity
from core.dynamics.gear import Gear
from core.dynamics.model import standard_model
from core.dynamics.prediction import Prediction
from core.dynamics.terms.elasticity import Elasticity, sprung
from core.signals.state import MotionState
from core.simulation.inverse import inverse_dynamics
from tests.core.diagnosis.scenes import measured_arm, skew_arm
from tests.core.dynamics.terms.motions import swinging
from tests.core.estimate.worlds import true_parameters

STEP, RESONANCE, RATIO = 0.004, 8.0, 0.07
ANGULAR = 2.0 * np.pi * RESONANCE
DAMPING = 2.0 * RATIO / ANGULAR


@pytest.mark.parametrize("frequency", [1.0, 4.0, 8.0, 16.0])
def test_a_spring_with_one_inertia_answers_a_wave_as_an_oscillator_does(frequency):
    time = np.arange(0.0, 10.0, STEP)
    wave = np.exp(2j * np.pi * frequency * time)
    gives = [
        sprung(np.ascontiguousarray(one), np.full(len(time), ANGULAR**-2), np.full(len(time), DAMPING), STEP)[
            :, 0
        ]
        for one in (wave.real, wave.imag)
    ]
    share = frequency / RESONANCE
    expected = 1.0 / (1.0 - share**2 + 2j * RATIO * share)
    settled = time > 5.0
    found = np.mean(((gives[0] + 1j * gives[1]) / wave)[settled])
    assert abs(found - expected) < 0.01 * abs(expected)


def test_a_spring_whose_inertia_changes_swings_as_its_equation_says():
    time = np.arange(0.0, 4.0, STEP)
    load = lambda at: np.sin(9.0 * at) + 0.5 * np.sin(31.0 * at)  # noqa: E731  (a formula)
    inertia = lambda at: (1.0 + 0.9 * np.sin(2.0 * at)) / ANGULAR**2  # noqa: E731  (a formula)
    damping = lambda at: (1.0 + 0.8 * np.cos(3.0 * at)) * DAMPING  # noqa: E731  (a formula)
    found = sprung(load(time), inertia(time), damping(time), STEP)

    def moving(at, state):
        rate = (load(at) - damping(at) * state[1] - state[0]) / inertia(at)
        return [state[1], rate]

    exact = solve_ivp(moving, (0.0, 4.0), found[0, :2], t_eval=time, rtol=1e-9, atol=1e-12).y.T
    exact = np.column_stack([exact, [moving(*one)[1] for one in zip(time, exact, strict=True)]])
    off = np.abs(found - exact)[1:]
    assert (off.max(axis=0) < 0.01 * np.abs(exact).max(axis=0)).all()


def test_the_motion_of_a_link_on_its_spring_is_one():
    """Position, rate and its rate belong together: the torque is a motion's, not three series'."""
    time = np.arange(0.0, 4.0, 0.001)
    place, rate, again = sprung(
        np.sin(9.0 * time), np.full(len(time), ANGULAR**-2), np.full(len(time), DAMPING), 0.001
    ).T
    for one, slope in ((place, rate), (rate, again)):
        off = np.gradient(one, 0.001)[2:-2] - slope[2:-2]
        assert np.abs(off).max() < 0.002 * np.abs(slope).max()


def test_the_column_is_what_the_load_changes_by_where_the_link_lags_behind_on_its_spring():
    """Against the whole equation, step by step (Runge and Kutta); what is not linear in it is small here."""
    model, state = standard_model(skew_arm()), swinging(3, 4.0)
    believed = Prediction(model, true_parameters(model), inverse_dynamics)
    inertia = Gear(believed, 1).inertia(state)
    assert inertia.max() > 1.2 * inertia.min()
    (column,) = Elasticity(1, believed, RESONANCE, RATIO, float(inertia.mean())).torques(skew_arm(), state)
    stiffness = inertia.mean() * ANGULAR**2
    motion = [CubicSpline(state.time, one) for one in (state.position, state.velocity, state.acceleration)]

    def load(at, *gives):
        here = (one(at)[None, :] - by * np.eye(3)[:1] for one, by in zip(motion, gives, strict=True))
        return believed.load(MotionState(*here))[0]

    def rate(at, gives):
        """Solve for the link's own rate, in which the load is linear."""
        rest, one = (load(at, *gives, size)[0] for size in (0.0, 1.0))
        drag = 2.0 * RATIO / ANGULAR * stiffness
        return np.array([gives[1], (rest - drag * gives[1] - stiffness * gives[0]) / (rest - one)])

    gives, exact = np.array([load(0.0, 0.0, 0.0, 0.0)[0] / stiffness, 0.0]), []
    for at in state.time:
        plain = load(at, 0.0, 0.0, 0.0)
        exact.append((load(at, *gives, rate(at, gives)[1]) - plain) * stiffness)
        first = rate(at, gives)
        second = rate(at + 0.5 * STEP, gives + 0.5 * STEP * first)
        third = rate(at + 0.5 * STEP, gives + 0.5 * STEP * second)
        fourth = rate(at + STEP, gives + STEP * third)
        gives = gives + STEP / 6.0 * (first + 2.0 * second + 2.0 * third + fourth)
    settled, whole = slice(500, 950), np.array(exact)
    np.testing.assert_allclose(column[settled], whole[settled], atol=0.03 * np.abs(whole[settled]).max())


def test_a_link_that_is_believed_to_weigh_nothing_still_has_columns():
    scene, model = measured_arm(), standard_model(skew_arm())
    nothing = Prediction(model, np.zeros(len(model.parameters)))
    cause, state = JointElasticity(), scene.look.stretches[0].state
    for scalars in cause.grid(scene.look, nothing, (1,)):
        (column,) = cause.term(scene.look, nothing, (1,), scalars).torques(skew_arm(), state)
        assert np.isfinite(column).all()
