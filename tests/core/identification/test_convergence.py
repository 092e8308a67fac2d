"""Laws of iteration: it ends at a fixed point, also where two robots call for each other, or says so."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest

from tests.core.estimate.worlds import log_of, planar_robot, swing, true_parameters
from veritorque.core.dynamics.model import standard_model
from veritorque.core.estimate.constraints import Prior
from veritorque.core.estimate.estimate import Estimate
from veritorque.core.estimate.methods.method import Step
from veritorque.core.estimate.methods.wls import WeightedLeastSquares
from veritorque.core.estimate.options import IterationOptions
from veritorque.core.estimate.problem import ObservedProblem, Problem
from veritorque.core.estimate.system import System
from veritorque.core.identification.convergence import converge
from veritorque.core.reduction.base import base_model
from veritorque.core.signals.condition import condition
from veritorque.core.signals.recipe import FilterOptions

NO_PRIOR = Prior(np.zeros(1), np.ones(1), "nominal")


@pytest.fixture(scope="module")
def data():
    """Give data that are handed on."""
    model = standard_model(planar_robot())
    motion = condition(log_of(model, true_parameters(model), swing(2)), model.robot, FilterOptions())
    problem = Problem(base_model(model), (motion,), frozenset())
    return ObservedProblem(problem, problem.observed())


@dataclass(frozen=True)
class Affine(WeightedLeastSquares):
    """An estimator whose estimate depends on the last one: next = slope last + 1."""

    slope: float = 0.0
    iterative: bool = True

    def equations(self, at, data):
        """Write one equation over one parameter."""
        target = 1.0 if at is None else self.slope * at[0] + 1.0
        return Step(System(np.eye(1), np.array([target]), 0.0, 10, np.ones(1)), data)


def answer(step):
    """Solve without constraints."""
    base = step.system.solved()
    return Estimate(base, base, base, step.system, NO_PRIOR, None)


def ended(data, slope, most=20, tolerance=1e-6):
    """Iterate."""
    options = IterationOptions(most, tolerance)
    _, found, how = converge(Affine(slope=slope), data, answer, options, lambda _: None)
    return found.base[0], how


@pytest.mark.parametrize("slope", [0.0, 0.5, -0.6, -1.0, -1.4])
def test_it_ends_at_the_fixed_point(data, slope):
    value, how = ended(data, slope, most=60)
    assert how.converged
    assert value == pytest.approx(1.0 / (1.0 - slope), rel=1e-5)
    assert how.steps[-1].change < 1e-6


def test_a_step_that_changes_more_halves_the_way(data):
    _, how = ended(data, -1.4)
    pairs = list(pairwise(how.steps))
    assert any(later.change > step.change for step, later in pairs)
    assert all(
        later.share == step.share * (0.5 if later.change > step.change else 1.0) for step, later in pairs
    )


def test_an_iteration_that_does_not_end_says_so(data):
    value, how = ended(data, 0.9, most=3)
    assert not how.converged
    assert "3 steps" in how.reason
    assert len(how.steps) == 3
    assert value < 10.0


def test_equations_that_do_not_depend_on_a_robot_are_solved_once(data):
    _, found, how = converge(
        Affine(slope=0.5, iterative=False), data, answer, IterationOptions(), lambda _: None
    )
    assert how.converged
    assert how.steps == ()
    assert found.base[0] == 1.0
