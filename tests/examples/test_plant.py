"""The outside engine: what sticks, what moves, and that the step is the engine's own forward dynamics."""

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from examples.yumi import arm
from examples.yumi.plant import Plant, pinocchio_model, velocity_under_friction

VALUES = st.floats(-3.0, 3.0)


@given(
    root=arrays(float, (4, 4), elements=VALUES),
    impulse=arrays(float, 4, elements=VALUES),
    guess=arrays(float, 4, elements=VALUES),
)
def test_friction_opposes_motion_at_its_bound_and_holds_still_below_it(root, impulse, guess):
    inertia = root @ root.T + np.eye(4)
    bound = np.array([0.2, 0.5, 1.0, 2.0])
    velocity = velocity_under_friction(inertia, impulse, bound, guess)
    friction = impulse - inertia @ velocity
    moving = velocity != 0.0
    np.testing.assert_allclose(friction[moving], (bound * np.sign(velocity))[moving], atol=1e-8)
    assert (np.abs(friction) <= bound + 1e-8).all()


def resting():
    return Plant(pinocchio_model(), 0.5 * (arm.LOWER + arm.UPPER), 1.0 / 4000.0)


def weight(plant):
    return pin.computeGeneralizedGravity(plant.model, plant.model.createData(), plant.position)


def test_an_arm_held_against_its_weight_does_not_creep_under_a_push_below_coulomb_friction():
    plant = resting()
    start = plant.position.copy()
    for _ in range(200):
        plant.advance(weight(plant) + arm.OFFSET + 0.9 * arm.COULOMB)
    assert np.array_equal(plant.position, start)


def test_an_arm_pushed_above_coulomb_friction_moves():
    plant = resting()
    plant.advance(weight(plant) + arm.OFFSET + 1.5 * arm.COULOMB)
    assert (plant.velocity != 0.0).any()


@pytest.mark.parametrize("seed", range(3))
def test_the_acceleration_is_that_of_the_articulated_body_algorithm(seed):
    generator = np.random.default_rng(seed)
    plant = resting()
    plant.velocity = generator.uniform(-2.0, 2.0, arm.JOINTS)
    before, speed = plant.position, plant.midpoint_velocity()
    torque = generator.uniform(-3.0, 3.0, arm.JOINTS)
    _, acceleration = plant.advance(torque)
    free = torque - arm.OFFSET - plant.friction
    expected = pin.aba(plant.model, plant.model.createData(), before, speed, free)
    np.testing.assert_allclose(acceleration, expected, rtol=1e-9, atol=1e-9)
