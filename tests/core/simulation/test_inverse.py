"""The compiled inverse dynamics against the plain recursion, for every shape of robot.

Two correct recursions differ by rounding, about 1e-15 of the largest torque per link; 1e-12 leaves room for
thirty links.
"""

import numpy as np
import pytest

from tests.tools import random_bodies, random_motion, random_robot, relative_difference, with_mimics
from veritorque.core.dynamics.newton_euler import inverse_dynamics as plain
from veritorque.core.signals.state import MotionState
from veritorque.core.simulation.inverse import inverse_dynamics

TOLERANCE = 1e-12


@pytest.mark.parametrize("tree", [False, True], ids=["chain", "tree"])
@pytest.mark.parametrize("links", [1, 2, 7, 30])
@pytest.mark.parametrize("prismatic", [0.0, 0.4, 1.0], ids=["revolute", "mixed", "prismatic"])
def test_the_compiled_torque_is_that_of_the_plain_recursion(links, tree, prismatic):
    rng = np.random.default_rng([links, tree, int(10 * prismatic)])
    robot = random_robot(rng, links, tree=tree, prismatic=prismatic)
    bodies = random_bodies(rng, links)
    motion = random_motion(rng, links, 130)
    state = MotionState(motion.position, motion.velocity, motion.acceleration)
    found = inverse_dynamics(robot, bodies, state)
    assert relative_difference(found, plain(robot, bodies, state)) < TOLERANCE


def test_the_compiled_torque_is_that_of_the_plain_recursion_where_joints_move_several_links():
    rng = np.random.default_rng(5)
    robot = with_mimics(random_robot(rng, 6, tree=True), rng)
    bodies = random_bodies(rng, 6)
    motion = random_motion(rng, len(robot.joints), 70)
    state = MotionState(motion.position, motion.velocity, motion.acceleration)
    found = inverse_dynamics(robot, bodies, state)
    assert relative_difference(found, plain(robot, bodies, state)) < TOLERANCE


def test_no_samples_give_no_torque():
    rng = np.random.default_rng(6)
    robot, bodies = random_robot(rng, 3), random_bodies(rng, 3)
    empty = np.zeros((0, 3))
    assert inverse_dynamics(robot, bodies, MotionState(empty, empty, empty)).shape == (0, 3)
