"""The plant against another engine, at rest, and against the model that its clean logs must fit."""

import numpy as np
import pinocchio as pin
import pytest

from tests.plant.cases import draw_world
from tests.plant.engine import Plant, simulate
from tests.plant.excitation import draw_excitation
from tests.plant.mechanism import STEPS_PER_SECOND
from tests.plant.robots import ROBOTS, Arm, draw_arm
from tests.plant.strength import nameable, residue
from veritorque.core.robot.inertia import mass_properties, pseudo_inertia


def pinocchio_model(arm: Arm) -> pin.Model:
    model = pin.Model()
    model.gravity.linear = np.asarray(arm.robot.gravity)
    carrier = 0
    for link, body in zip(arm.robot.links, arm.bodies, strict=True):
        placement = pin.SE3(link.rotation, link.translation)
        carrier = model.addJoint(carrier, pin.JointModelRZ(), placement, link.name)
        mass, centre, inertia = mass_properties(body)
        model.appendBodyToJoint(carrier, pin.Inertia(mass, centre, inertia), pin.SE3.Identity())
    model.armature = arm.rotor_inertia
    return model


def without_friction(arm: Arm) -> Arm:
    none = np.zeros(arm.joints)
    robot = type(arm.robot)(arm.robot.name, arm.robot.links, arm.robot.joints, arm.robot.gravity)
    changed = {
        "robot": robot,
        "viscous": none,
        "coulomb": none + 1e-12,
        "offset": none,
        "motors": np.empty((0, 3)),
    }
    return Arm(**{**vars(arm), **changed})


@pytest.mark.parametrize("name", ROBOTS)
def test_without_friction_the_plant_accelerates_as_pinocchio_says(name):
    rng = np.random.default_rng(3)
    arm = without_friction(draw_arm(name, rng))
    model = pinocchio_model(arm)
    position, velocity, torque = rng.uniform(-1.0, 1.0, (3, arm.joints))
    plant = Plant(arm, (), position)
    plant.velocity[:] = velocity
    none = np.zeros(arm.joints)
    plant.advance(torque, none, none)
    wanted = pin.aba(model, model.createData(), position, velocity, torque)
    np.testing.assert_allclose(plant.acceleration, wanted, rtol=1e-9, atol=1e-9 * np.abs(wanted).max())


@pytest.mark.parametrize("name", ROBOTS)
def test_every_drawn_body_is_physically_consistent(name):
    arm = draw_arm(name, np.random.default_rng(8))
    assert min(np.linalg.eigvalsh(pseudo_inertia(body))[0] for body in arm.bodies) > 0.0
    assert min(arm.rotor_inertia.min(), arm.viscous.min(), arm.coulomb.min()) > 0.0


def speed_after(arm: Arm, share: float) -> float:
    """Push every joint of a horizontal plane's arm with a share of its Coulomb friction for half a second."""
    plant = Plant(arm, (), np.zeros(arm.joints))
    none = np.zeros(arm.joints)
    for _ in range(STEPS_PER_SECOND // 2):
        plant.advance(arm.offset + share * arm.coulomb, none, none)
    return float(np.abs(plant.velocity).max())


@pytest.mark.parametrize("name", ["planar-2", "planar-3"])
def test_a_joint_under_less_than_its_coulomb_friction_sticks(name):
    arm = draw_arm(name, np.random.default_rng(4))
    weightless = Arm(
        **{**vars(arm), "robot": type(arm.robot)(name, arm.robot.links, arm.robot.joints, np.zeros(3))}
    )
    assert speed_after(weightless, 0.9) < 1e-6
    assert speed_after(weightless, 1.1) > 1e-3


@pytest.mark.parametrize("name", ROBOTS)
def test_the_excitation_keeps_its_bounds_starts_and_ends_at_rest_and_reverses_often(name):
    rng = np.random.default_rng(5)
    arm = draw_arm(name, rng)
    time = np.arange(0.0, 30.0, 0.004)
    position, velocity, acceleration = draw_excitation(arm, rng).at(time)
    assert np.all((position > arm.lower) & (position < arm.upper))
    assert np.all(np.abs(velocity) < arm.speed)
    assert np.all(np.abs(acceleration) <= 1.01 * arm.acceleration)
    assert np.abs(velocity[[0, -1]]).max() < 1e-3
    assert np.all(np.sum(np.diff(np.sign(velocity), axis=0) != 0, axis=0) >= 10)


@pytest.mark.parametrize("name", ROBOTS)
def test_the_standard_model_explains_a_clean_log_to_a_hundredth_of_its_noise(name):
    world = draw_world(np.random.default_rng(6), 6, robot=name, duration=8.0)
    signals = world.clean.sampled(smooth=True)
    left = residue(world.arm.robot, signals, signals.torque, world.noise_rms, "white")
    assert left.strength.max() < 0.01
    assert not nameable(left.noncentrality)


def test_the_arm_follows_its_reference():
    rng = np.random.default_rng(7)
    world = draw_world(rng, 7, robot="franka-panda", duration=8.0)
    recording = simulate(world.arm, (), world.steering)
    start = recording.position[0]
    assert np.abs(recording.position[-1] - start).max() < 0.02
    assert np.ptp(recording.position, axis=0).min() > 0.3
