"""Hold the translation of solver statuses to completeness: only an optimum is success."""

import warnings

import clarabel
import cvxpy
import numpy as np
import pytest

from tests.core.estimate.worlds import planar_robot, world_of
from veritorque.core.errors import SolverError
from veritorque.core.estimate import with_clarabel, with_cvxpy
from veritorque.core.estimate.constraints import Bounds
from veritorque.core.estimate.programme import Programme, refusal
from veritorque.core.estimate.with_clarabel import solve_with_clarabel
from veritorque.core.estimate.with_cvxpy import solve_with_cvxpy

CLARABEL = sorted(name for name in dir(clarabel.SolverStatus) if name[0].isupper())
CVXPY = sorted(
    {*cvxpy.settings.SOLUTION_PRESENT, *cvxpy.settings.INF_OR_UNB, *cvxpy.settings.ERROR, "infeasible"}
)


def _programme() -> Programme:
    world = world_of(planar_robot(), samples=50)
    return Programme(world.base, world.system, world.prior, Bounds())


class _Answer:
    def __init__(self, status: str, values: np.ndarray) -> None:
        self.status, self.x, self.iterations = status, values, 7


@pytest.mark.parametrize("status", CLARABEL)
def test_every_status_of_clarabel_but_solved_is_refused_with_cause_and_remedy(status, monkeypatch):
    class Solver:
        def __init__(self, quadratic: object, *_: object) -> None:
            self.size = quadratic.shape[0]

        def solve(self) -> _Answer:
            return _Answer(status, np.ones(self.size))

    monkeypatch.setattr(with_clarabel.clarabel, "DefaultSolver", Solver)
    if status == "Solved":
        assert solve_with_clarabel(_programme()).status == "optimal"
        return
    with pytest.raises(SolverError) as caught:
        solve_with_clarabel(_programme())
    assert caught.value.cause
    assert caught.value.remedy
    assert caught.value.evidence == {"status": status, "solver": "clarabel", "iterations": 7}


def test_the_statuses_that_clarabel_knows_are_the_ones_that_were_looked_at():
    assert set(with_clarabel._KINDS) < set(CLARABEL)
    assert {"Solved", "PrimalInfeasible", "DualInfeasible", "AlmostSolved", "MaxIterations"} < set(CLARABEL)


@pytest.mark.parametrize("status", CVXPY)
def test_every_status_of_cvxpy_but_optimal_is_refused(status, monkeypatch):
    problem = with_cvxpy.cvxpy.Problem

    class Stopped(problem):
        status = property(lambda _self: status)

        def solve(self, **options: object) -> None:
            super().solve(**options)

    monkeypatch.setattr(with_cvxpy.cvxpy, "Problem", Stopped)
    if status == cvxpy.OPTIMAL:
        assert solve_with_cvxpy(_programme()).status == "optimal"
        return
    with pytest.raises(SolverError) as caught:
        solve_with_cvxpy(_programme())
    assert caught.value.evidence["status"] == status
    assert caught.value.remedy


def test_a_solver_that_raises_is_refused_as_ours(monkeypatch):
    class Broken(with_cvxpy.cvxpy.Problem):
        def solve(self, **_options: object) -> None:
            raise cvxpy.error.SolverError("numerical trouble")

    monkeypatch.setattr(with_cvxpy.cvxpy, "Problem", Broken)
    with pytest.raises(SolverError, match="stopped without an optimum"):
        solve_with_cvxpy(_programme())


def test_an_infeasible_problem_and_an_inaccurate_one_have_different_remedies():
    remedies = {
        kind: refusal(kind, status="", solver="", iterations=0).remedy
        for kind in ("infeasible", "inaccurate")
    }
    assert "bounds" in remedies["infeasible"]
    assert "option solver" in remedies["inaccurate"]


def test_where_rounding_stops_the_solver_less_is_asked_for_in_shorter_steps_before_giving_up(monkeypatch):
    asked = []

    class Solver:
        def __init__(self, quadratic: object, *rest: object) -> None:
            asked.append((rest[-1].tol_gap_rel, rest[-1].max_step_fraction))
            self.size = quadratic.shape[0]

        def solve(self) -> _Answer:
            return _Answer("Solved" if len(asked) > 1 else "InsufficientProgress", np.ones(self.size))

    monkeypatch.setattr(with_clarabel.clarabel, "DefaultSolver", Solver)
    assert solve_with_clarabel(_programme()).status == "optimal"
    assert asked == [(1e-9, 0.99), (1e-7, 0.9)]


def test_an_inaccurate_solution_is_refused_by_cvxpy_as_ours_and_not_by_a_warning(monkeypatch):
    class Hesitant(with_cvxpy.cvxpy.Problem):
        status = "optimal_inaccurate"

        def solve(self, **_options: object) -> None:
            warnings.warn("Solution may be inaccurate.", UserWarning, stacklevel=2)

    monkeypatch.setattr(with_cvxpy.cvxpy, "Problem", Hesitant)
    with pytest.raises(SolverError, match="accuracy"):
        solve_with_cvxpy(_programme())
