"""Hold the certificate of feasibility: it passes every physically consistent robot, and no other."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.core.estimate.worlds import World, planar_robot, world_of
from tests.tools import random_robot
from veritorque.core.estimate import feasibility as module
from veritorque.core.estimate.feasibility import active_constraints, feasibility
from veritorque.core.robot.inertia import from_mass_properties


@settings(max_examples=10)
@given(seed=st.integers(0, 10_000), links=st.integers(1, 5))
def test_the_base_parameters_of_a_consistent_robot_are_feasible(seed, links):
    world = world_of(random_robot(np.random.default_rng(seed), links), seed=seed, samples=60)
    assert feasibility(world.base, world.true_base, world.prior).feasible


@pytest.mark.parametrize(
    ("name", "value"), [("ZZ2", -0.01), ("IA2", -0.2), ("FV1", -0.1), ("FC2", -0.1), ("ZZR1", -0.3)]
)
def test_a_parameter_that_no_robot_has_is_refused_even_when_the_rest_is_right(name, value):
    world = world_of(planar_robot())
    values = world.true_base
    values[world.base.names.index(name)] = value
    found = feasibility(world.base, values, world.prior)
    assert not found.feasible
    assert found.margin < 0.0


def test_an_inertia_smaller_than_its_own_first_moments_demand_is_refused_though_every_sign_is_right():
    # Some mass has ZZ2 M2 >= MX2^2; but M2 enters MXR1 = MX1 + 0.4 M2 and ZZR1 = ZZ1 + 0.16 M2 too.
    world = world_of(planar_robot())
    values = world.true_base
    values[world.base.names.index("ZZ2")] = 1e-3
    values[world.base.names.index("MX2")] = 1.0
    values[world.base.names.index("ZZR1")] = 1.0
    assert not feasibility(world.base, values, world.prior).feasible


def test_a_body_that_breaks_the_triangle_inequality_is_refused_though_its_mass_is_open():
    # |XX - YY| <= ZZ for every body; the last link's XX - YY and ZZ are known, its YY and mass are not.
    robot = random_robot(np.random.default_rng(1), 6, prismatic=0.0)
    world = world_of(robot)
    last = from_mass_properties(1.0, np.zeros(3), np.diag([0.05, 0.01, 0.01]))
    values = world.truth.copy()
    values[50:60] = last
    assert not feasibility(world.base, world.base.base_of(values), world.prior).feasible


def test_feasibility_does_not_depend_on_the_units_of_the_prior():
    world = world_of(planar_robot())
    wide = module.Prior(world.prior.centre, 10.0 * world.prior.scale, "nominal")
    assert feasibility(world.base, world.true_base, wide).feasible


def _solver_that_says(status: str) -> type:
    class Solver:
        x = np.zeros(1)
        iterations = 3

        def __init__(self, *_: object) -> None:
            self.status = status

        def solve(self) -> "Solver":
            return self

    return Solver


def test_a_certificate_that_the_solver_did_not_finish_is_no_certificate(monkeypatch):
    world = world_of(planar_robot())
    monkeypatch.setattr(module.clarabel, "DefaultSolver", _solver_that_says("MaxIterations"))
    found = feasibility(world.base, world.true_base, world.prior)
    assert (found.feasible, found.margin) == (None, None)


def _held(world: World, *, plausible: bool = False, **changes: float) -> tuple[str, ...]:
    values = world.truth.copy()
    names = [one.name for one in world.model.parameters]
    for name, value in changes.items():
        values[names.index(name)] = value
    bounds = module.Bounds(plausible=plausible)
    return active_constraints(world.model, values, world.prior, bounds)


def test_the_constraints_that_hold_an_estimate_are_named():
    world = world_of(planar_robot())
    assert _held(world) == ()
    assert _held(world, FC1=0.0) == ("FC1",)
    assert _held(world, IA2=0.0, XX1=0.0, YY1=0.0) == ("pseudo_inertia_1", "IA2")
    needle = _held(world, plausible=True, XX1=0.0, YY1=0.0)
    assert {"pseudo_inertia_1", "density_1"} <= set(needle)
    assert "size_2" in _held(world, plausible=True, ZZ2=100.0)
    assert "size_2" not in _held(world, plausible=True, MX2=0.0, MY2=0.0, XX2=0.01, YY2=0.01, ZZ2=0.01)


def test_least_squares_may_be_consistent_and_need_a_link_that_is_too_large():
    world = world_of(planar_robot())
    values = world.truth.copy()
    names = [one.name for one in world.model.parameters]
    for symbol, value in (("XX", 3.0), ("YY", 3.0), ("ZZ", 3.0)):  # half axes of 1.4 m on a link of 0.4 m
        values[names.index(f"{symbol}2")] = value
    far = world.base.base_of(values)
    assert feasibility(world.base, far, world.prior).feasible
    mass = ((2, 0.0, float(values[names.index("M2")])),)
    asked = module.Bounds(mass=mass)
    assert not feasibility(world.base, far, world.prior, asked).feasible
    assert feasibility(world.base, world.true_base, world.prior, asked).feasible
