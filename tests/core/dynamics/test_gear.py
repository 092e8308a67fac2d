"""Hold what a gear transmits to the link's own dynamics: the rotor's inertia is none of it."""

from dataclasses import replace

import numpy as np
import pytest

from tests.core.diagnosis.scenes import skew_arm
from tests.core.dynamics.terms.motions import swinging
from tests.core.estimate.worlds import true_parameters
from veritorque.core.dynamics.gear import Gear
from veritorque.core.dynamics.model import standard_model
from veritorque.core.dynamics.prediction import Prediction
from veritorque.core.dynamics.terms.backlash import Backlash
from veritorque.core.dynamics.terms.effect import step_of
from veritorque.core.dynamics.terms.friction_load_dependent import LoadFriction
from veritorque.core.dynamics.terms.joint_elasticity import Elasticity
from veritorque.core.dynamics.terms.payload_change import Payload
from veritorque.core.dynamics.terms.spring_compensator import Spring
from veritorque.core.dynamics.terms.viscous import Viscous
from veritorque.core.signals.derivative import differentiate_throughout

ROTOR = 0.7
TERMS = {
    "load_friction": lambda described, rotor: LoadFriction(1, described, rotor),
    "spring": lambda described, rotor: Elasticity(1, described, 10.0, 20.0, 0.1, rotor),
    "play": lambda described, rotor: Backlash(1, described, 2e-3, 40.0, rotor),
}


def believed_apart_and_joined():
    """Predict by the link as it is, and by one that a rotor's inertia was joined to."""
    model = standard_model(skew_arm())
    apart = true_parameters(model)
    joined = apart.copy()
    joined[[one.name for one in model.parameters].index("ZZ1")] += ROTOR
    return Prediction(model, apart), Prediction(model, joined)


@pytest.mark.parametrize("which", ["load", "inertia", "change"])
def test_a_rotor_that_was_joined_to_its_link_is_taken_out_of_the_load_again(which):
    """The first link's moment about its axis and the rotor's inertia are one number to any fit."""
    state = swinging(3, 2.0)
    lag = np.sin(3.0 * state.time)

    def seen(gear):
        return {
            "load": lambda: gear.load(state),
            "inertia": lambda: gear.inertia(state),
            "change": lambda: gear.displaced(state, lag),
        }[which]()

    link, both = (Gear(one, 1) for one in believed_apart_and_joined())
    np.testing.assert_allclose(seen(replace(both, motor_inertia=ROTOR)), seen(link), rtol=1e-9, atol=1e-9)
    assert np.abs(seen(both) - seen(link)).max() > 0.1 * ROTOR


@pytest.mark.parametrize("samples", [3, 4, 200])
def test_a_link_that_lies_off_its_motor_changes_the_loads_by_its_own_motion(samples):
    """Its speed and acceleration are taken as those of positions are, ends included."""
    state = swinging(3, 2.0).at(slice(0, samples))
    described, _ = believed_apart_and_joined()
    lag = 1e-3 * np.cos(40.0 * state.time)
    speed = differentiate_throughout(lag[:, None], 1.0 / step_of(state))
    bend = differentiate_throughout(speed, 1.0 / step_of(state))
    slopes = described.slopes(state, 1)
    expected = sum(slope * part for slope, part in zip(slopes, (lag[:, None], speed, bend), strict=True))
    size = np.abs(expected).max()
    np.testing.assert_allclose(
        Gear(described, 2).displaced(state, lag), expected, rtol=0.0, atol=1e-14 * size
    )


@pytest.mark.parametrize("term", TERMS.values(), ids=TERMS)
def test_what_acts_on_the_load_does_not_feel_a_rotor_that_is_known(term):
    state, (apart, joined) = swinging(3, 2.0), believed_apart_and_joined()
    right, mended, wrong = (
        term(*one).series(skew_arm(), state) for one in ((apart, 0.0), (joined, ROTOR), (joined, 0.0))
    )
    size = np.abs(right).max()
    np.testing.assert_allclose(mended, right, atol=1e-6 * size)
    assert np.abs(wrong - right).max() > 0.01 * size


def test_a_gear_transmits_a_body_that_joined_the_model_and_no_friction_that_did():
    state, (described, _) = swinging(3, 2.0), believed_apart_and_joined()
    body = np.array([0.1, 0.0, 0.0, 0.2, 0.0, 0.3, 0.4, 0.1, 0.0, 2.0])
    heavier = described.standard.copy()
    heavier[:10] += body
    carried = replace(described, joined=((Payload(1, 1, -np.inf), body), (Viscous(), np.ones(3))))
    found, expected = (Gear(one, 1).load(state) for one in (carried, replace(described, standard=heavier)))
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-9)


def test_a_gear_is_not_known_to_transmit_a_spring_of_which_nobody_knows_where_it_rests():
    state, (described, _) = swinging(3, 2.0), believed_apart_and_joined()
    sprung = replace(described, joined=((Spring(1), np.array([30.0])),))
    np.testing.assert_array_equal(Gear(sprung, 1).load(state), Gear(described, 1).load(state))
    assert np.abs(sprung.applied(state) - described.applied(state)).max() > 1.0
