"""A body's ellipsoid is the body: same mass, same mass centre, same inertia, however its frame lies."""

import numpy as np
import pytest

from tests.core.estimate.worlds import planar_robot, true_parameters
from tests.tools import random_bodies
from veritorque.core.document.bodies import body_rows, solid_ellipsoid
from veritorque.core.dynamics.model import standard_model
from veritorque.core.robot.frames import rotation_rpy
from veritorque.core.robot.inertia import from_mass_properties, mass_properties, transform_body

BODIES = random_bodies(np.random.default_rng(5), 20)


def inertia_of_ellipsoid(mass, half_axes, axes):
    """Integrate over a solid ellipsoid: m/5 (b^2 + c^2) about its first axis (Siciliano et al. 2009, A.3)."""
    squares = half_axes**2
    return axes @ np.diag(mass / 5.0 * (squares.sum() - squares)) @ axes.T


@pytest.mark.parametrize("link", BODIES)
def test_the_ellipsoid_has_the_inertia_of_the_body(link):
    mass, _, inertia = mass_properties(link)
    half_axes, axes = solid_ellipsoid(link)
    assert inertia_of_ellipsoid(mass, half_axes, axes) == pytest.approx(inertia, rel=1e-9, abs=1e-12)
    assert axes.T @ axes == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1.0)


@pytest.mark.parametrize("link", BODIES[:5])
def test_another_frame_turns_the_ellipsoid_and_leaves_its_size(link):
    turned = transform_body(link, rotation_rpy(0.3, -0.8, 2.0), np.array([0.1, -0.4, 0.2]))
    assert solid_ellipsoid(turned)[0] == pytest.approx(solid_ellipsoid(link)[0], rel=1e-6)


def test_a_body_that_breaks_the_triangle_inequality_has_nothing_to_draw():
    thin = from_mass_properties(1.0, np.zeros(3), np.diag([0.1, 0.1, 0.3]))
    assert solid_ellipsoid(thin) == (None, None)


def test_a_body_without_mass_has_nothing_to_draw():
    assert solid_ellipsoid(np.zeros(10)) == (None, None)


def test_every_link_of_a_model_with_bodies_has_one_and_other_models_have_none():
    model = standard_model(planar_robot())
    rows = body_rows(model, true_parameters(model, mass=2.0))
    assert [row["link"] for row in rows] == [1, 2]
    assert [row["mass"] for row in rows] == [
        value
        for parameter, value in zip(model.parameters, true_parameters(model, mass=2.0), strict=True)
        if parameter.symbol == "M"
    ]
    light = standard_model(planar_robot(), ("viscous",))
    assert body_rows(light, np.ones(2)) == []
