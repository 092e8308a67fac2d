"""A compliant gear swings as its link's inertia does: as a lumped spring at rest, and along a motion."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from core.diagnosis.causes.joint_elasticity import JointElasticity
from core.dynamics.gear import Gear
from core.dynamics.model import standard_model
from core.dynamics.prediction import Prediction, moved
from core.dynamics.terms.elasticity import Elasticity, sprung
from core.signals.state import MotionState
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
        sprung(np.ascontiguousarray(one), np.full(len(time), ANGULAR**-2), DAMPING, STEP)[:, 0]
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
    found = sprung(load(time), inertia(time), DAMPING, STEP)

    def moving(at, state):
        rate = (load(at) - DAMPING * state[1] - state[0]) / inertia(at)
        return [state[1], rate]

    exact = solve_ivp(moving, (0.0, 4.0), [0.0, 0.0], t_eval=time, rtol=1e-9, atol=1e-12).y.T
    exact = np.column_stack([exact, [moving(*one)[1] for one in zip(time, exact, strict=True)]])
    off = np.abs(found - exact)[1:]
    assert (off.max(axis=0) < 0.01 * np.abs(exact).max(axis=0)).all()


def test_the_motion_of_a_link_on_its_spring_is_one():
    """Position, rate and its rate belong together: the torque is a motion's, not three series'."""
    time = np.arange(0.0, 4.0, 0.001)
    place, rate, again = sprung(np.sin(9.0 * time), np.full(len(time), ANGULAR**-2), DAMPING, 0.001).T
    for one, slope in ((place, rate), (rate, again)):
        off = np.gradient(one, 0.001)[2:-2] - slope[2:-2]
        assert np.abs(off).max() < 0.002 * np.abs(slope).max()


def test_the_column_is_what_the_load_changes_by_when_the_link_lags_behind():
    """To first order: a compliance of a thousandth of what it is leaves a thousandth of the second order."""
    model, state = standard_model(skew_arm()), swinging(3)
    believed = Prediction(model, true_parameters(model))
    inertia = Gear(believed, 1).inertia(state)
    term = Elasticity(1, believed, RESONANCE, RATIO, float(inertia.mean()))
    (column,) = term.torques(skew_arm(), state)
    stiffness = inertia.mean() * ANGULAR**2
    gives = sprung(believed.load(state)[:, 0], inertia / stiffness, DAMPING, STEP)
    small = 1e-6
    there = moved(state, 0, MotionState(*(-small * gives.T[:, :, None])))
    change = (believed.load(there) - believed.load(state)) / small
    np.testing.assert_allclose(column, change, atol=1e-4 * np.abs(change).max())
    assert inertia.max() > 1.2 * inertia.min()


def test_a_link_that_is_believed_to_weigh_nothing_still_has_a_column():
    scene, model = measured_arm(), standard_model(skew_arm())
    nothing = Prediction(model, np.zeros(len(model.parameters)))
    scalars = {"resonance_hz": RESONANCE, "damping_ratio": RATIO}
    (column,) = (
        JointElasticity()
        .term(scene.look, nothing, (1,), scalars)
        .torques(skew_arm(), scene.look.stretches[0].state)
    )
    assert np.isfinite(column).all()
