"""Hold the mass matrix to another engine's, and its positivity to the links that imply it."""

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.core.estimate.worlds import planar_robot, true_parameters, wrist_robot
from tests.tools import pinocchio_model, random_robot
from veritorque.core.dynamics.model import standard_model
from veritorque.core.robot.builtin import builtin_robot
from veritorque.core.validation.mass_matrix import (
    check_mass_matrix,
    mass_matrices,
    pseudo_inertia_eigenvalues,
    workspace,
)


@settings(max_examples=10)
@given(seed=st.integers(0, 10_000), links=st.integers(1, 8), tree=st.booleans())
def test_the_mass_matrix_is_pinocchios_with_the_rotor_inertias_on_its_diagonal(seed, links, tree):
    rng = np.random.default_rng(seed)
    robot = random_robot(rng, links, tree=tree)
    model = standard_model(robot)
    values = true_parameters(model, seed)
    bodies = values[: 10 * links].reshape(links, 10)
    engine = pinocchio_model(robot, bodies)
    data = engine.createData()
    rotors = [values[k] for k, one in enumerate(model.parameters) if one.symbol == "IA"]
    position = rng.uniform(-np.pi, np.pi, (4, links))
    for q, found in zip(position, mass_matrices(model, values, position), strict=True):
        upper = np.triu(pin.crba(engine, data, q))
        theirs = upper + np.triu(upper, 1).T + np.diag(rotors)
        np.testing.assert_allclose(found, theirs, atol=1e-10 * np.abs(theirs).max())


@settings(max_examples=15)
@given(seed=st.integers(0, 10_000), links=st.integers(1, 12), mass=st.sampled_from([1e-3, 1.0, 1e4]))
def test_consistent_links_have_a_positive_mass_matrix_everywhere(seed, links, mass):
    robot = random_robot(np.random.default_rng(seed), links, tree=True)
    model = standard_model(robot)
    values = true_parameters(model, seed, mass)
    assert min(pseudo_inertia_eigenvalues(model, values)) > 0.0
    check = check_mass_matrix(model, values, workspace(robot, 50))
    assert check.positive
    assert check.min_eigenvalue > 0.0
    assert check.configurations == 50


def test_a_coupled_motor_couples_its_joints_in_the_mass_matrix():
    model = standard_model(wrist_robot())
    values = true_parameters(model)
    names = [one.name for one in model.parameters]
    without = values.copy()
    without[names.index("IAM3")] = 0.0
    position = np.zeros((1, 3))
    difference = mass_matrices(model, values, position)[0] - mass_matrices(model, without, position)[0]
    own = values[names.index("IAM3")]
    np.testing.assert_allclose(difference, own * np.array([[0, 0, 0], [0, 1, 1], [0, 1, 1]]), atol=1e-14)


def test_a_robot_with_a_negative_rotor_inertia_is_caught_where_it_shows():
    model = standard_model(planar_robot())
    values = true_parameters(model)
    values[[one.name for one in model.parameters].index("IA2")] = -1.0
    check = check_mass_matrix(model, values, workspace(model.robot, 20))
    assert not check.positive
    assert check.min_eigenvalue < 0.0


def test_the_workspace_is_inside_the_limits_and_the_same_tomorrow():
    robot = builtin_robot("yumi-left")
    one = workspace(robot)
    assert one.shape == (10_000, 7)
    assert np.all((one >= robot.lower_positions) & (one <= robot.upper_positions))
    assert np.array_equal(one, workspace(robot))
    # Evenly: the mean of ten thousand uniform draws lies within four deviations of the middle.
    width = robot.upper_positions - robot.lower_positions
    middle = 0.5 * (robot.upper_positions + robot.lower_positions)
    assert np.all(np.abs(one.mean(axis=0) - middle) < 4.0 * width / np.sqrt(12.0 * 10_000))


def test_a_long_trajectory_is_looked_at_to_its_end():
    model = standard_model(planar_robot())
    values = true_parameters(model)
    values[[one.name for one in model.parameters].index("ZZ2")] = 1e-6
    values[[one.name for one in model.parameters].index("IA2")] = 0.0
    stretched = np.zeros((4001, 2))
    stretched[-1, 1] = 1.3
    ends = [check_mass_matrix(model, values, one) for one in (stretched, stretched[-1:], stretched[:1])]
    assert ends[0].min_eigenvalue == pytest.approx(min(ends[1].min_eigenvalue, ends[2].min_eigenvalue))
    assert ends[1].min_eigenvalue != ends[2].min_eigenvalue
