"""Hold the priors to what they promise: they decide what the motion leaves open, and nothing else."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import null_space

from tests.core.estimate.worlds import World, planar_robot, true_parameters, world_of
from tests.tools import random_bodies, random_robot
from veritorque.core.errors import OptionError
from veritorque.core.estimate.constraints import Bounds, Prior, link_columns
from veritorque.core.estimate.estimate import estimate
from veritorque.core.estimate.options import EstimateOptions
from veritorque.core.robot.frames import rotation_rpy
from veritorque.core.robot.inertia import pseudo_inertia, transform_body
from veritorque.core.robot.model import Joint, Link, RobotModel


def _believing(world: World, centre: np.ndarray) -> World:
    return replace(world, prior=Prior(centre, world.prior.scale, "robot"))


def _fit(world: World, **options: object) -> np.ndarray:
    return estimate(world.base, world.system, world.prior, EstimateOptions(**options)).standard


def test_what_the_motion_does_not_determine_keeps_the_value_of_the_prior():
    world = world_of(random_robot(np.random.default_rng(0), 3, prismatic=0.0), samples=400, noise=1e-4)
    believed = true_parameters(world.model, seed=77)
    found = _fit(_believing(world, believed))
    free = null_space(world.base.grouping * world.prior.scale)
    units = (found - believed) / world.prior.scale
    # In open directions only the pull and the links' margins act; the pull alone would leave none.
    assert np.linalg.norm(free.T @ units) < 0.5 * np.linalg.norm(units)
    np.testing.assert_allclose(world.base.base_of(found), world.true_base, atol=2e-3)


def test_a_right_prior_gives_the_whole_robot_back():
    world = world_of(random_robot(np.random.default_rng(0), 3), samples=400, noise=1e-5)
    found = _fit(_believing(world, world.truth), bounds=Bounds(margin=0.0, plausible=False))
    np.testing.assert_allclose(found / world.prior.scale, world.truth / world.prior.scale, atol=2e-3)


def test_a_stronger_entropic_prior_brings_the_bodies_nearer_to_those_of_the_prior():
    world = world_of(random_robot(np.random.default_rng(0), 2, prismatic=0.0), samples=300, noise=0.05)
    believed = _believing(world, true_parameters(world.model, seed=5))
    distances = [
        _divergence(believed, _fit(believed, solver="cvxpy", entropy=entropy)) for entropy in (1e-3, 1.0, 1e3)
    ]
    assert distances[0] > distances[1] > distances[2]


def _divergence(world: World, standard: np.ndarray) -> float:
    total = 0.0
    for columns in link_columns(world.model):
        here, there = (pseudo_inertia(one[list(columns)]) for one in (standard, world.prior.centre))
        ratio = np.linalg.solve(there, here)
        total += np.trace(ratio) - np.linalg.slogdet(ratio)[1] - 4.0
    return float(total)


def _turning(robot: RobotModel, turn: float) -> tuple[RobotModel, np.ndarray]:
    """Describe the same one-link robot with its link frame turned about the joint's axis."""
    link = robot.links[0]
    rotation = rotation_rpy(0.0, 0.0, turn)
    turned = Link(link.name, link.kind, 0, 1, link.rotation @ rotation, link.translation)
    return replace(robot, links=(turned,)), rotation


def test_the_entropic_prior_does_not_depend_on_the_frame_that_bodies_are_written_in():
    robot = RobotModel(
        "pendulum",
        (Link("arm", "revolute", 0, 1, rotation_rpy(0.3, 1.1, 0.0), np.array([0.1, 0.0, 0.2])),),
        (Joint("hinge"),),
        np.array([0.0, 0.0, -9.81]),
    )
    turned, rotation = _turning(robot, 0.9)
    body = random_bodies(np.random.default_rng(3), 1)[0]
    first, second = world_of(robot, seed=1), world_of(turned, seed=1)
    columns = list(link_columns(first.model)[0])
    answers = []
    for world, believed in ((first, body), (second, transform_body(body, rotation.T, np.zeros(3)))):
        centre, scale = world.truth.copy(), first.prior.scale
        centre[columns] = believed
        # The data speak of the same torque: the equations are those of the second world's own frame.
        standard = estimate(
            world.base,
            _about(first, world, rotation),
            Prior(centre, scale, "robot"),
            EstimateOptions(
                solver="cvxpy", entropy=1e2, pull=1e-9, bounds=Bounds(margin=0.0, plausible=False)
            ),
        ).standard
        answers.append(standard[columns])
    np.testing.assert_allclose(transform_body(answers[1], rotation, np.zeros(3)), answers[0], atol=2e-4)


def _about(first: World, world: World, rotation: np.ndarray) -> object:
    """Write the first world's equations in another world's base parameters."""
    if world is first:
        return first.system
    columns = list(link_columns(first.model)[0])
    change = np.eye(len(first.truth))
    change[np.ix_(columns, columns)] = np.column_stack(
        [transform_body(unit, rotation, np.zeros(3)) for unit in np.eye(10)]
    )
    # base of the first world as a function of the second's standard parameters, and those of its base
    onto = np.zeros((len(world.truth), len(world.base.kept)))
    onto[list(world.base.kept), range(len(world.base.kept))] = 1.0
    return replace(first.system, triangle=first.system.triangle @ first.base.grouping @ change @ onto)


def test_the_entropic_prior_is_refused_where_the_solver_cannot_state_it():
    with pytest.raises(OptionError, match="cvxpy"):
        EstimateOptions(entropy=1.0, solver="clarabel")


def test_a_planar_robot_without_data_about_a_parameter_gives_it_the_value_of_the_prior():
    world = world_of(planar_robot(), noise=1e-3, samples=300)
    believed = true_parameters(world.model, seed=9)
    found = _fit(_believing(world, believed), bounds=Bounds(margin=0.0, plausible=False))
    # MZ, XZ, YZ have no effect on a planar arm; nothing but the belief speaks of them, as far as the entries
    # that the log does tell leave a physically consistent body: a quarter of a unit.
    for column, parameter in enumerate(world.model.parameters):
        if parameter.symbol in {"XZ", "YZ", "MZ"}:
            assert found[column] == pytest.approx(believed[column], abs=0.25 * world.prior.scale[column])
