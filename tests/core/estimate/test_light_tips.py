"""A light tip, a point mass and a link without a body are identified; a benchmark runs 200 of them."""

import numpy as np
import pytest

from benchmarks.light_tips import Case, solved
from tests.core.estimate.worlds import planar_robot, world_of
from veritorque.core.errors import SolverError
from veritorque.core.estimate import estimate as module
from veritorque.core.estimate.constraints import DEFAULT_MARGIN, LIGHT_MARGIN, Bounds
from veritorque.core.estimate.options import EstimateOptions
from veritorque.core.estimate.programme import Programme, Solution, refusal


@pytest.mark.parametrize("prior", [True, False])
@pytest.mark.parametrize(("mass", "inertia"), [(0.0, 0.0), (0.2, 0.0), (0.02, 1e-7), (0.02, 1e-4)])
def test_a_light_tip_is_identified_and_hardly_costs_any_fit(mass, inertia, prior):
    # Without the lighter margin consistency costs 1.5 to 60 times; the first statement alone has no optimum.
    found = solved(Case(6, mass, inertia, 0.003, prior=prior, seed=0))
    assert found.objective < 1.05 * found.objective_unconstrained
    assert found.solution.margin in (DEFAULT_MARGIN, LIGHT_MARGIN)


def test_the_optimum_of_a_point_mass_is_the_one_that_the_readable_statement_finds():
    case = Case(3, 0.2, 0.0, 0.003, prior=True, seed=0)
    ours, theirs = solved(case), solved(case, "cvxpy")
    assert ours.objective <= theirs.objective * (1.0 + 1e-4)
    spread = np.abs(ours.system.triangle @ (ours.base - theirs.base)).max()
    assert spread < 1.0  # of a standard deviation


def test_an_ordinary_robot_keeps_the_ordinary_margin():
    world = world_of(planar_robot(), samples=200)
    found = module.estimate(world.base, world.system, world.prior, EstimateOptions())
    assert found.solution.margin == DEFAULT_MARGIN


def test_a_margin_that_was_asked_for_is_kept_and_so_is_the_default_where_it_is_not_what_costs(monkeypatch):
    world = world_of(planar_robot(), samples=200)
    asked = []

    def solve(programme: Programme, _solver: str) -> Solution:
        asked.append(programme.bounds.margin)
        return Solution(np.zeros(len(world.base.model.parameters)), "optimal", 1, "none", asked[-1])

    monkeypatch.setattr(module, "solve", solve)
    module.estimate(world.base, world.system, world.prior, EstimateOptions(bounds=Bounds(margin=1e-3)))
    assert asked == [1e-3]
    found = module.estimate(world.base, world.system, world.prior, EstimateOptions())
    assert asked == [1e-3, DEFAULT_MARGIN, LIGHT_MARGIN]
    assert found.solution.margin == DEFAULT_MARGIN


def test_the_default_margin_is_kept_where_a_smaller_one_has_no_accurate_optimum(monkeypatch):
    world = world_of(planar_robot(), samples=200)

    def solve(programme: Programme, solver: str) -> Solution:
        if programme.bounds.margin == LIGHT_MARGIN:
            raise refusal("stopped", status="AlmostSolved", solver=solver, iterations=30)
        zeros = np.zeros(len(world.base.model.parameters))
        return Solution(zeros, "optimal", 1, "none", programme.bounds.margin)

    monkeypatch.setattr(module, "solve", solve)
    found = module.estimate(world.base, world.system, world.prior, EstimateOptions())
    assert found.solution.margin == DEFAULT_MARGIN


def test_no_refusal_of_a_solver_names_the_motion_as_its_reason():
    for kind in ("inaccurate", "stopped"):
        said = refusal(kind, status="", solver="", iterations=0)
        assert isinstance(said, SolverError)
        assert "motion" not in said.remedy
