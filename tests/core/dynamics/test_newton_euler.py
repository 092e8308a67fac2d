"""Newton-Euler against engines that are not ours, in every regime, and against the laws of mechanics.

Tolerance: two correct recursions of 30 joints differ by rounding, about 1e-13 of the joint's largest torque;
1e-10 leaves room for cancellation and none for a wrong formula.
"""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tools import (
    ENGINES,
    Engine,
    Motion,
    random_bodies,
    random_motion,
    random_robot,
    relative_difference,
    with_mimics,
)
from veritorque.core.dynamics.newton_euler import inverse_dynamics, unit_torques
from veritorque.core.robot.inertia import pseudo_inertia
from veritorque.core.robot.model import Link, RobotModel
from veritorque.core.signals.state import MotionState

TOLERANCE = 1e-10


def _torque(robot: RobotModel, bodies: np.ndarray, motion: Motion) -> np.ndarray:
    return inverse_dynamics(robot, bodies, MotionState(motion.position, motion.velocity, motion.acceleration))


@pytest.fixture(params=ENGINES)
def engine(request) -> Engine:
    return ENGINES[request.param]


@pytest.mark.parametrize("tree", [False, True], ids=["chain", "tree"])
@pytest.mark.parametrize("links", [1, 2, 3, 7, 14, 30])
@pytest.mark.parametrize("prismatic", [0.0, 0.4, 1.0], ids=["revolute", "mixed", "prismatic"])
def test_newton_euler_gives_the_torque_of_other_engines(engine, links, tree, prismatic):
    rng = np.random.default_rng([links, tree, int(10 * prismatic)])
    robot = random_robot(rng, links, tree=tree, prismatic=prismatic)
    bodies, motion = random_bodies(rng, links), random_motion(rng, links)
    assert relative_difference(_torque(robot, bodies, motion), engine(robot, bodies, motion)) < TOLERANCE


@pytest.mark.parametrize("mass", [1e-6, 1e6], ids=["a milligram", "a thousand tons"])
@pytest.mark.parametrize("speed", [0.0, 1e-6, 30.0], ids=["at rest", "creeping", "spinning"])
def test_newton_euler_gives_the_torque_of_other_engines_for_every_mass_and_speed(engine, mass, speed):
    rng = np.random.default_rng([int(np.log10(mass)) + 10, int(speed)])
    robot = random_robot(rng, 6, tree=True)
    bodies, motion = random_bodies(rng, 6, mass=mass), random_motion(rng, 6, speed=speed)
    assert relative_difference(_torque(robot, bodies, motion), engine(robot, bodies, motion)) < TOLERANCE


def test_newton_euler_gives_the_torque_of_other_engines_at_constant_velocity(engine):
    rng = np.random.default_rng(3)
    robot, bodies, motion = random_robot(rng, 7), random_bodies(rng, 7), random_motion(rng, 7)
    steady = Motion(motion.position, motion.velocity, np.zeros_like(motion.velocity))
    assert relative_difference(_torque(robot, bodies, steady), engine(robot, bodies, steady)) < TOLERANCE


def test_newton_euler_gives_the_torque_of_other_engines_with_one_joint_frozen(engine):
    rng = np.random.default_rng(4)
    robot, bodies, motion = random_robot(rng, 7), random_bodies(rng, 7), random_motion(rng, 7)
    for series in (motion.position, motion.velocity, motion.acceleration):
        series[:, 3] = 0.0
    assert relative_difference(_torque(robot, bodies, motion), engine(robot, bodies, motion)) < TOLERANCE


def test_newton_euler_carries_the_torque_of_mimic_links_to_their_joint(engine):
    rng = np.random.default_rng(5)
    robot = with_mimics(random_robot(rng, 9, tree=True), rng)
    assert len(robot.joints) == 6
    bodies, motion = random_bodies(rng, 9), random_motion(rng, 6)
    assert relative_difference(_torque(robot, bodies, motion), engine(robot, bodies, motion)) < TOLERANCE


@pytest.mark.parametrize("prismatic", [0.0, 0.4, 1.0], ids=["revolute", "mixed", "prismatic"])
def test_what_each_parameter_of_each_link_brings_adds_up_to_the_torque_of_other_engines(engine, prismatic):
    rng = np.random.default_rng([8, int(10 * prismatic)])
    robot = with_mimics(random_robot(rng, 9, tree=True, prismatic=prismatic), rng)
    bodies, motion = random_bodies(rng, 9), random_motion(rng, len(robot.joints))
    state = MotionState(motion.position, motion.velocity, motion.acceleration)
    torque = sum(
        np.einsum("p,psj->sj", body, unit_torques(robot, number, state))
        for number, body in enumerate(bodies, start=1)
    )
    assert relative_difference(torque, engine(robot, bodies, motion)) < TOLERANCE


def test_a_link_without_its_body_is_noticed(engine):
    rng = np.random.default_rng(6)
    robot, bodies, motion = random_robot(rng, 7), random_bodies(rng, 7), random_motion(rng, 7)
    wrong = bodies.copy()
    wrong[3] = 0.0
    assert relative_difference(_torque(robot, wrong, motion), engine(robot, bodies, motion)) > 1e-3


@given(st.integers(0, 2**32 - 1), st.integers(1, 12), st.booleans())
def test_the_power_of_the_joints_is_the_change_of_energy(seed, links, tree):
    rng = np.random.default_rng(seed)
    robot = with_mimics(random_robot(rng, links, tree=tree), rng)
    bodies, motion = random_bodies(rng, links), random_motion(rng, len(robot.joints), samples=1)
    power = float(_torque(robot, bodies, motion)[0] @ motion.velocity[0])
    change, size = _energy_change(robot, bodies, motion)
    assert abs(power - change) < 1e-11 * size


def _energy_change(robot: RobotModel, bodies: np.ndarray, motion: Motion) -> tuple[float, float]:
    """Differentiate the energy by 4x4 matrices: dE/dt = sum trace(T' J (T'' - G)').

    G holds the acceleration of gravity. The second value sums the absolute terms: the scale of rounding.
    """
    fall = np.zeros((4, 4))
    fall[:3, 3] = robot.gravity
    still = (np.eye(4), np.zeros((4, 4)), np.zeros((4, 4)))
    poses: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    change, size = 0.0, 0.0
    for link, body in zip(robot.links, bodies, strict=True):
        carrier = poses[link.antecedent - 1] if link.antecedent else still
        poses.append(_pose_jet(carrier, link, motion))
        term = poses[-1][1] @ pseudo_inertia(body) * (poses[-1][2] - fall)
        change += term.sum()
        size += np.abs(term).sum()
    return change, size


def _pose_jet(
    carrier: tuple[np.ndarray, np.ndarray, np.ndarray], link: Link, motion: Motion
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Give a link's pose with its first and second derivatives in time."""
    column = link.joint - 1
    coordinate = link.ratio * motion.position[0, column] + link.offset
    rate, rate_change = link.ratio * motion.velocity[0, column], link.ratio * motion.acceleration[0, column]
    generator, move, place = np.zeros((4, 4)), np.eye(4), np.eye(4)
    if link.kind == "revolute":
        generator[1, 0], generator[0, 1] = 1.0, -1.0
        move += np.sin(coordinate) * generator + (1.0 - np.cos(coordinate)) * generator @ generator
    else:
        generator[2, 3] = 1.0
        move += coordinate * generator
    place[:3, :3], place[:3, 3] = link.rotation, link.translation
    first = place @ generator @ move * rate
    second = place @ (generator @ generator * rate**2 + generator * rate_change) @ move
    zero = place @ move
    return (
        carrier[0] @ zero,
        carrier[1] @ zero + carrier[0] @ first,
        carrier[2] @ zero + 2.0 * carrier[1] @ first + carrier[0] @ second,
    )
