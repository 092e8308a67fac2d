"""Hold the feasible estimate to what it promises: a physically consistent robot, at the least price."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.core.estimate.worlds import World, planar_robot, world_of, wrist_robot
from tests.tools import random_robot
from veritorque.core.errors import OptionError, SolverError
from veritorque.core.estimate.constraints import Bounds, CentreBox, CentreEllipsoid, congruence, link_columns
from veritorque.core.estimate.estimate import Estimate, estimate
from veritorque.core.estimate.options import PULL, EstimateOptions
from veritorque.core.estimate.system import stacked
from veritorque.core.robot.inertia import pseudo_inertia
from veritorque.core.robot.model import RobotModel

SOLVER_GAP = 5e-8
"""Both solvers close the gap to 1e-8, relative to an objective near one half; two of them, and room."""
PULL_SHARE = 1e-3
"""The pull may cost a thousandth of chi^2: 0.02 per squared unit against n equations of variance one."""


def _fit(world: World, **options: object) -> Estimate:
    return estimate(world.base, world.system, world.prior, EstimateOptions(**options))


def _robot(seed: int, links: int) -> RobotModel:
    return random_robot(np.random.default_rng(seed), links)


def _least_eigenvalue(world: World, standard: np.ndarray) -> float:
    """Give the least eigenvalue of all scaled pseudo-inertias."""
    least = np.inf
    for columns in link_columns(world.model):
        weights = congruence(world.prior, columns)
        body = pseudo_inertia(standard[list(columns)]) * np.outer(weights, weights)
        least = min(least, np.linalg.eigvalsh(body)[0])
    return float(least)


@settings(max_examples=12)
@given(seed=st.integers(0, 10_000), links=st.integers(1, 4), noise=st.sampled_from([1e-3, 0.3, 5.0]))
def test_a_feasible_estimate_is_consistent_and_never_beats_the_unconstrained_cost(seed, links, noise):
    world = world_of(_robot(seed, links), seed=seed, noise=noise)
    found = _fit(world, bounds=Bounds(margin=1e-4))
    assert _least_eigenvalue(world, found.standard) >= 1e-4 * (1.0 - 1e-3)
    for parameter, value in zip(world.model.parameters, found.standard, strict=True):
        if parameter.symbol in {"IA", "FV", "FC", "M"}:
            assert value >= -1e-6, parameter.name
    assert found.objective >= found.objective_unconstrained * (1.0 - 1e-9)
    np.testing.assert_allclose(found.base, world.base.base_of(found.standard), rtol=1e-12, atol=1e-12)


def test_where_least_squares_is_feasible_the_feasible_estimate_costs_no_more_than_the_pull():
    world = world_of(_robot(3, 3), seed=3, samples=400, noise=1e-3)
    found = _fit(world)
    assert found.objective <= found.objective_unconstrained * (1.0 + PULL_SHARE)
    np.testing.assert_allclose(found.base, found.unconstrained, atol=5e-3)


def test_noise_that_makes_least_squares_impossible_costs_the_feasible_estimate_something():
    world = world_of(_robot(4, 4), seed=4, samples=60, noise=6.0)
    found = _fit(world)
    assert found.objective > found.objective_unconstrained * (1.0 + PULL_SHARE)


BOUNDS = {
    "none": Bounds(),
    "margin": Bounds(margin=1e-2),
    "mass": Bounds(mass=((1, 0.5, 1.0), (3, 2.5, 4.0))),
    "total mass": Bounds(total_mass=(1.0, 3.5)),
    "box": Bounds(centres=(CentreBox(2, (-0.05, -0.05, -0.05), (0.05, 0.05, 0.05)),)),
    "ellipsoid": Bounds(centres=(CentreEllipsoid(2, (0.1, 0.0, 0.0), (0.02, 0.03, 0.04)),)),
    "all": Bounds(
        mass=((1, 0.5, 3.0),),
        total_mass=(2.0, 6.0),
        centres=(
            CentreBox(1, (-0.2, -0.2, -0.2), (0.2, 0.2, 0.2)),
            CentreEllipsoid(3, (0.0, 0.0, 0.0), (0.1, 0.1, 0.1)),
        ),
    ),
}


@pytest.mark.parametrize("bounds", BOUNDS.values(), ids=BOUNDS.keys())
def test_both_solvers_find_the_same_robot_and_honour_every_bound(bounds):
    world = world_of(_robot(11, 3), seed=11, samples=80, noise=1.0)
    direct, stated = (_fit(world, bounds=bounds, solver=solver) for solver in ("clarabel", "cvxpy"))
    assert direct.objective == pytest.approx(stated.objective, rel=1e-5)
    # Around it the objective grows by at least (||R step||^2 + pull ||step / scale||^2) / (2 n).
    predicted = world.system.triangle @ (direct.base - stated.base)
    assert predicted @ predicted / (2.0 * world.system.rows) <= SOLVER_GAP
    step = (direct.standard - stated.standard) / world.prior.scale
    assert PULL / world.system.rows * step @ step / 2.0 <= SOLVER_GAP
    for found in (direct, stated):
        _assert_bounds(world, found.standard, bounds)


def _assert_bounds(world: World, standard: np.ndarray, bounds: Bounds) -> None:
    links = link_columns(world.model)
    slack = 1e-5
    assert _least_eigenvalue(world, standard) >= bounds.margin - 1e-6
    for link, low, high in bounds.mass:
        assert low - slack <= standard[links[link - 1][9]] <= high + slack
    if bounds.total_mass is not None:
        total = sum(standard[columns[9]] for columns in links)
        assert bounds.total_mass[0] - slack <= total <= bounds.total_mass[1] + slack
    for region in bounds.centres:
        columns = list(links[region.link - 1])
        centre = standard[columns[6:9]] / standard[columns[9]]
        if isinstance(region, CentreBox):
            assert np.all(centre >= np.array(region.low) - slack)
            assert np.all(centre <= np.array(region.high) + slack)
        else:
            assert np.linalg.norm((centre - region.centre) / region.semi_axes) <= 1.0 + 1e-3


@pytest.mark.parametrize("solver", ["clarabel", "cvxpy"])
def test_bounds_that_contradict_each_other_are_refused_and_named_as_the_reason(solver):
    world = world_of(_robot(5, 2), seed=5)
    bounds = Bounds(mass=((1, 1.0, 2.0), (2, 1.0, 2.0)), total_mass=(5.0, 6.0))
    with pytest.raises(SolverError, match="no robot satisfies the bounds") as refusal:
        _fit(world, bounds=bounds, solver=solver)
    assert "widen the bounds" in refusal.value.remedy
    assert refusal.value.evidence["solver"] == solver


@pytest.mark.parametrize("solver", ["clarabel", "cvxpy"])
def test_a_mass_may_be_fixed_exactly(solver):
    world = world_of(_robot(5, 2), seed=5)
    found = _fit(world, bounds=Bounds(mass=((2, 1.25, 1.25),)), solver=solver)
    assert found.standard[link_columns(world.model)[1][9]] == pytest.approx(1.25, abs=1e-6)


@pytest.mark.parametrize(
    "bounds",
    [
        Bounds(mass=((3, 1.0, 2.0),)),
        Bounds(mass=((0, 1.0, 2.0),)),
        Bounds(centres=(CentreBox(7, (0.0,) * 3, (1.0,) * 3),)),
    ],
)
def test_a_bound_on_a_link_that_does_not_exist_is_refused_by_its_number(bounds):
    world = world_of(_robot(5, 2), seed=5)
    with pytest.raises(OptionError, match="link"):
        _fit(world, bounds=bounds)


def test_relabelling_the_joints_relabels_the_estimate():
    # Two arms on one base, once A then B and once B then A: the numbers change, the robot does not.
    rng = np.random.default_rng(8)
    one = random_robot(rng, 2, prismatic=0.0)
    other = replace(one, links=tuple(replace(link, antecedent=0) for link in one.links))
    swapped = replace(
        other,
        links=tuple(
            replace(link, joint=number) for number, link in enumerate(reversed(other.links), start=1)
        ),
    )
    first = world_of(other, seed=8, samples=120, noise=0.5)
    factors, columns_of = tuple(reversed(first.factors)), _reversed_columns(first, swapped)
    second = world_of(swapped, seed=8)
    system = stacked(factors, columns_of, len(second.base.kept), first.system.noise[::-1].copy())
    prior = replace(
        second.prior,
        scale=_relabelled(first, second, first.prior.scale),
        centre=_relabelled(first, second, first.prior.centre),
    )
    here = _fit(first)
    there = estimate(second.base, system, prior, EstimateOptions())
    np.testing.assert_allclose(there.standard, _relabelled(first, second, here.standard), atol=1e-5)


def _relabelled(first: World, second: World, values: np.ndarray) -> np.ndarray:
    by_name = {
        (one.symbol, 3 - one.number): value for one, value in zip(first.model.parameters, values, strict=True)
    }
    return np.array([by_name[one.symbol, one.number] for one in second.model.parameters])


def _reversed_columns(first: World, swapped: RobotModel) -> tuple[np.ndarray, ...]:
    second = world_of(swapped, seed=8)
    place = {
        (second.base.parameter(row).symbol, second.base.parameter(row).number): row
        for row in range(len(second.base.kept))
    }
    return tuple(
        np.array(
            [
                place[first.base.parameter(row).symbol, 3 - first.base.parameter(row).number]
                for row in columns.tolist()
            ]
        )
        for columns in reversed(first.columns_of)
    )


def test_a_coupled_motor_is_found_with_its_inertia_and_its_frictions_not_negative():
    world = world_of(wrist_robot(), seed=2, samples=400, noise=0.02)
    found = _fit(world)
    values = dict(zip((one.name for one in world.model.parameters), found.standard, strict=True))
    true = dict(zip((one.name for one in world.model.parameters), world.truth, strict=True))
    for name in ("FVM3", "FCM3", "IAM3"):
        assert values[name] >= 0.0
        assert values[name] == pytest.approx(true[name], abs=0.03)


def test_a_one_link_planar_robot_and_a_robot_without_gravity_are_identified_too():
    for robot in (
        planar_robot(),
        random_robot(np.random.default_rng(1), 1),
        random_robot(np.random.default_rng(2), 3, gravity=False),
    ):
        world = world_of(robot, seed=6, samples=300, noise=0.01)
        found = _fit(world)
        np.testing.assert_allclose(found.base, world.true_base, atol=0.02)
