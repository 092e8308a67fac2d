"""Hold what a gear transmits to the link's own dynamics: the rotor's inertia is none of it."""

from dataclasses import replace

import numpy as np
import pytest

from core.dynamics.gear import Gear
from core.dynamics.model import standard_model
from core.dynamics.prediction import Prediction
from core.signals.state import MotionState
from tests.core.diagnosis.scenes import skew_arm
from tests.core.dynamics.terms.motions import swinging
from tests.core.estimate.worlds import true_parameters

ROTOR = 0.7


@pytest.mark.parametrize("which", ["load", "inertia", "change"])
def test_a_rotor_that_was_joined_to_its_link_is_taken_out_of_the_load_again(which):
    """The first link's moment about its axis and the rotor's inertia are one number to any fit."""
    model, state = standard_model(skew_arm()), swinging(3, 2.0)
    apart = true_parameters(model)
    joined = apart.copy()
    joined[[one.name for one in model.parameters].index("ZZ1")] += ROTOR
    shift = MotionState(*(np.sin(np.outer(state.time, [rate])) for rate in (1.0, 2.0, 3.0)))

    def seen(gear):
        return {
            "load": lambda: gear.load(state),
            "inertia": lambda: gear.inertia(state),
            "change": lambda: gear.change(state, shift),
        }[which]()

    link, both = Gear(Prediction(model, apart), 1), Gear(Prediction(model, joined), 1)
    np.testing.assert_allclose(seen(replace(both, motor_inertia=ROTOR)), seen(link), rtol=1e-9, atol=1e-9)
    assert np.abs(seen(both) - seen(link)).max() > 0.1 * ROTOR
