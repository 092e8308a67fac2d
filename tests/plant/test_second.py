"""The second world: its torque is that of an engine that is not its own, and its joints stick."""

import numpy as np
import pinocchio as pin
import pytest

from tests.plant import second
from tests.plant.second_effects import ALL


@pytest.fixture(scope="module")
def body():
    return second._body(np.random.default_rng(3))


def test_the_equations_are_those_of_another_engine(body):
    model = pin.Model()
    model.gravity.linear = np.array([0.0, -second.GRAVITY, 0.0])
    shifts = (np.zeros(3), np.array([second.LINK, 0.0, 0.0]))
    masses = (6.0, body.coupling / (second.LINK * 0.2))
    centres = (body.weights[0] / second.GRAVITY - masses[1] * second.LINK) / masses[0], 0.2
    own = (body.first - masses[1] * second.LINK**2, body.second)
    carrier = 0
    for shift, mass, centre, inertia in zip(shifts, masses, centres, own, strict=True):
        carrier = model.addJoint(carrier, pin.JointModelRZ(), pin.SE3(np.eye(3), shift), f"joint_{carrier}")
        about = np.diag([1.0, 1.0, inertia - mass * centre**2])
        model.appendBodyToJoint(
            carrier, pin.Inertia(mass, np.array([centre, 0.0, 0.0]), about), pin.SE3.Identity()
        )
    rng, data = np.random.default_rng(4), model.createData()
    for angle, rate, bend in rng.normal(size=(20, 3, 2)):
        needed = (body.mass(angle) - np.diag(body.rotors)) @ bend + body.bias(angle, rate)
        np.testing.assert_allclose(needed, pin.rnea(model, data, angle, rate, bend), rtol=1e-9, atol=1e-9)


def test_a_joint_that_rests_stays_at_rest_below_its_level_and_moves_above(body):
    angle, rate = np.array([0.3, 0.5]), np.zeros(2)
    weight = body.bias(angle, rate)
    for share, moves in ((0.9, False), (1.5, True)):
        after, friction = second._moved(body, angle, rate, weight + share * body.coulomb, np.zeros(2))
        assert (np.abs(after) > 1e-9).any() == moves
        assert (np.abs(friction) <= body.coulomb * (1.0 + 1e-12)).all()


def simulated(body, *changes):
    """Give 3 s of positions and torques with some changes."""
    reference = second._reference(np.random.default_rng(5), 1.0)
    return second._simulate(second._World(body, reference, second.Drive(15.0, 1e-9), changes), 3.0)


@pytest.fixture(scope="module")
def unchanged(body):
    return np.hstack(simulated(body))


@pytest.mark.parametrize("effect", ALL, ids=lambda effect: effect.cause)
def test_every_effect_changes_what_is_logged(body, unchanged, effect):
    change = effect(0, 0.4, 0.7, 30.0)
    position, torque = simulated(body, change)
    log = (np.arange(len(position)) / second.RATE_HZ, position, torque)
    changed = np.hstack(change.logged(log)[1:])
    differ = np.abs(changed - unchanged).max() > 1e-3
    assert differ == (effect.cause not in {"payload_change", "external_contact"})  # these come later
