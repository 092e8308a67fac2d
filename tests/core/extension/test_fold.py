"""Hold a folded model to the torque of the model that it came from."""

import numpy as np
import pytest

from tests.core.diagnosis.scenes import skew_arm
from tests.core.dynamics.terms.motions import swinging
from tests.core.estimate.worlds import true_parameters
from veritorque.core.dynamics.model import standard_model
from veritorque.core.dynamics.terms.friction_asymmetric import AsymmetricViscous
from veritorque.core.dynamics.terms.friction_change import FrictionChange
from veritorque.core.dynamics.terms.link_parameters import LinkChange
from veritorque.core.dynamics.terms.payload_change import Payload
from veritorque.core.extension.fold import fold
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.writing import to_description

CHANGES = (Payload(3, 3, -np.inf), LinkChange(2, 2), FrictionChange(1))


@pytest.mark.parametrize("term", CHANGES, ids=lambda one: one.kind)
def test_a_change_is_the_same_robot_with_other_parameters(term):
    model = standard_model(skew_arm())
    wider, state = model.with_term(term), swinging(3, 2.0)
    added = 0.1 * np.random.default_rng(1).normal(size=len(term.parameters(model.robot)))
    standard = np.append(true_parameters(model), added)
    plain, values = fold(wider, standard)
    assert plain.terms == model.terms
    np.testing.assert_allclose(plain.torque(values, state), wider.torque(standard, state), atol=1e-9)


def test_what_is_no_change_of_a_parameter_stays_a_term():
    late, uneven = Payload(3, 3, 1.0), AsymmetricViscous(1)
    model = standard_model(skew_arm()).with_term(late).with_term(uneven)
    standard = np.arange(len(model.parameters), dtype=float)
    plain, values = fold(model, standard)
    assert plain.terms == model.terms
    np.testing.assert_array_equal(values, standard)


def test_friction_that_the_description_does_not_have_stays_a_term():
    description = to_description(skew_arm())
    description["joints"][0]["friction"] = ["viscous"]
    model = standard_model(robot_from_description(description)).with_term(FrictionChange(1))
    plain, _ = fold(model, np.ones(len(model.parameters)))
    assert plain.terms == model.terms
