"""Hold bodies to what they are asked for: none larger than its link, none denser than metal."""

import numpy as np
import pytest

from tests.core.estimate.worlds import World, planar_robot, world_of
from tests.tools import random_robot
from veritorque.core.document.bodies import solid_ellipsoid
from veritorque.core.estimate.constraints import Bounds, CentreBox, LinkSize, link_columns
from veritorque.core.estimate.estimate import estimate
from veritorque.core.estimate.options import EstimateOptions
from veritorque.core.estimate.plausibility import DENSEST, SMALLEST, link_bounds, second_moments
from veritorque.core.robot.extent import mean_distance
from veritorque.core.robot.inertia import from_mass_properties


def _fit(world: World, solver: str = "clarabel", **bounds: object):
    return estimate(
        world.base, world.system, world.prior, EstimateOptions(solver=solver, bounds=Bounds(**bounds))
    )


def _bodies(world: World, standard: np.ndarray) -> list[np.ndarray]:
    return [standard[list(columns)] for columns in link_columns(world.model)]


def _noisy(seed: int = 4) -> World:
    """Give a world whose noise drives bodies to the boundary of the feasible set."""
    return world_of(random_robot(np.random.default_rng(seed), 4), seed=seed, samples=60, noise=6.0)


def test_a_ball_of_the_densest_metal_is_just_allowed():
    radius = (3.0 * 2.0 / (4.0 * np.pi * DENSEST)) ** (1.0 / 3.0)
    ball = from_mass_properties(2.0, np.array([0.3, 0.0, 0.1]), 0.4 * 2.0 * radius**2 * np.eye(3))
    np.testing.assert_allclose(second_moments(ball), SMALLEST * 2.0 ** (5.0 / 3.0) * np.eye(3), atol=1e-12)
    assert radius == pytest.approx(0.0288, abs=1e-4)


@pytest.mark.parametrize("solver", ["clarabel", "cvxpy"])
def test_no_body_is_denser_than_metal_or_larger_than_its_link(solver):
    world = _noisy()
    free, found = (_fit(world, solver, plausible=plausible) for plausible in (False, True))
    densities = []
    for fit in (free, found):
        axes = [solid_ellipsoid(body)[0] for body in _bodies(world, fit.standard)]
        masses = [body[9] for body in _bodies(world, fit.standard)]
        volumes = [4.0 / 3.0 * np.pi * np.prod(half) for half in axes]
        densities.append(max(mass / volume for mass, volume in zip(masses, volumes, strict=True)))
    assert densities[0] > 3.0 * DENSEST  # else nothing is shown here
    assert densities[1] <= DENSEST * (1.0 + 1e-3)
    for link, body in zip(
        link_bounds(world.model, Bounds(), world.prior), _bodies(world, found.standard), strict=True
    ):
        assert mean_distance(body, link.extent.ball.centre) <= link.extent.ball.radius * (1.0 + 1e-4)
        centre = body[6:9] / body[9]
        assert np.linalg.norm(centre - link.extent.ball.centre) <= link.extent.ball.radius * (1.0 + 1e-4)


@pytest.mark.parametrize("seed", [4, 7])
def test_both_solvers_find_the_same_plausible_robot(seed):
    world = _noisy(seed)
    direct, stated = (_fit(world, solver) for solver in ("clarabel", "cvxpy"))
    assert direct.objective == pytest.approx(stated.objective, rel=1e-5)
    np.testing.assert_allclose(
        direct.standard / world.prior.scale, stated.standard / world.prior.scale, atol=2e-3
    )


def test_what_is_asked_costs_never_less_than_what_is_not_asked():
    world = _noisy()
    least, free, found = world.system.solved(), _fit(world, plausible=False), _fit(world)
    assert world.system.cost(least) <= free.objective <= found.objective * (1.0 + 1e-9)


def test_a_declared_size_stands_before_the_assumed_one_and_a_placed_centre_replaces_it():
    world = _noisy()
    size = LinkSize(2, (0.0, 0.0, 0.0), 0.05)
    found = _fit(world, sizes=(size,))
    assert mean_distance(_bodies(world, found.standard)[1], size.centre) <= 0.05 * (1.0 + 1e-3)
    assert link_bounds(world.model, Bounds(sizes=(size,)), world.prior)[1].extent.source == "declared"
    far = CentreBox(3, (2.0, 2.0, 2.0), (2.1, 2.1, 2.1))
    assert link_bounds(world.model, Bounds(centres=(far,)), world.prior)[2].extent is None
    placed = _bodies(world, _fit(world, centres=(far,)).standard)[2]
    assert np.all(placed[6:9] / placed[9] > 1.99)


def _with_long_tool() -> World:
    """Give an arm of 0.4 m whose last link carries a bar that reaches 3 m, which the log shows clearly."""
    world = world_of(planar_robot(), noise=1e-2, samples=300)
    bar = from_mass_properties(2.0, np.array([1.5, 0.0, 0.0]), 1.5 * np.diag([1e-3, 1.0, 1.0]))
    truth = world.truth.copy()
    truth[list(link_columns(world.model)[1])] = bar
    return world_of(planar_robot(), noise=1e-2, samples=300, truth=truth)


def test_a_link_that_is_larger_than_assumed_is_let_go_and_named_with_what_its_bound_costs():
    world = _with_long_tool()
    found = _fit(world)
    (costly,) = found.costly
    assert costly.bound.link == 2
    assert costly.ratio > 2.0
    assert found.cost_ratio < 1.02


def test_a_declared_size_is_kept_whatever_it_costs_and_a_right_one_costs_nothing():
    world = _with_long_tool()
    small, right = (
        _fit(world, sizes=(LinkSize(2, (0.0, 0.0, 0.0), 0.3),)),
        _fit(world, sizes=(LinkSize(2, (1.5, 0.0, 0.0), 2.0),)),
    )
    assert [one.bound.link for one in small.costly] == [2]
    assert small.cost_ratio > 2.0
    assert mean_distance(_bodies(world, small.standard)[1], (0.0, 0.0, 0.0)) <= 0.3 * (1.0 + 1e-3)
    assert (right.costly, right.cost_ratio < 1.02) == ((), True)


def test_a_robot_whose_bodies_are_plausible_is_never_told_that_they_are_not():
    world = _with_long_tool()
    truth = world.truth.copy()
    for columns in link_columns(world.model):
        truth[list(columns)] = world.prior.centre[list(columns)]
    for noise in (1e-3, 0.3, 6.0):
        noisy = world_of(planar_robot(), noise=noise, samples=60, truth=truth)
        assert _fit(noisy).costly == ()
