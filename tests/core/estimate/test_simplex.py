"""Let the seed paper's direct search look for a cheaper robot than the semidefinite programme's."""

import numpy as np
import pytest
from scipy.optimize import minimize

from tests.core.estimate.worlds import World, planar_robot, true_parameters, world_of
from veritorque.core.estimate.constraints import Bounds, congruence, lower_bounds
from veritorque.core.estimate.estimate import estimate
from veritorque.core.estimate.options import PULL, EstimateOptions
from veritorque.core.estimate.plausibility import SMALLEST, link_bounds
from veritorque.core.robot.inertia import pseudo_inertia

SOLVER_GAP = 2e-8
EVALUATIONS = 6000


def _world() -> World:
    return world_of(planar_robot(), seed=12, samples=40, noise=4.0)


def _objective(world: World, standard: np.ndarray) -> float:
    """Give the programme's objective, written anew; infinite for an implausible robot."""
    for link in link_bounds(world.model, Bounds(), world.prior):
        weights, body = congruence(world.prior, link.columns), standard[list(link.columns)]
        least = SMALLEST * max(body[9], 0.0) ** (5.0 / 3.0) * np.diag([1.0, 1.0, 1.0, 0.0])
        scaled = (pseudo_inertia(body) - least) * np.outer(weights, weights)
        if np.linalg.eigvalsh(scaled)[0] < Bounds().margin or link.row @ body < 0.0:
            return np.inf
    if np.any(standard < lower_bounds(world.model)):
        return np.inf
    system = world.system
    miss = system.target - system.triangle @ world.base.base_of(standard)
    step = (standard - world.prior.centre) / world.prior.scale
    return float((miss @ miss + PULL * step @ step) / (2.0 * system.rows))


@pytest.mark.parametrize("start", ["optimum", "random"])
def test_no_direct_search_finds_a_cheaper_consistent_robot(start):
    world = _world()
    best = estimate(world.base, world.system, world.prior, EstimateOptions()).standard
    inside = 0.999 * best + 0.001 * world.prior.centre
    random = 0.2 * true_parameters(world.model, seed=31) + 0.8 * world.prior.centre
    begin = inside if start == "optimum" else random
    assert np.isfinite(_objective(world, begin))
    scale = world.prior.scale
    options = {"maxfev": EVALUATIONS, "maxiter": EVALUATIONS, "adaptive": True, "xatol": 1e-9, "fatol": 1e-12}
    found = minimize(
        lambda units: _objective(world, units * scale), begin / scale, method="Nelder-Mead", options=options
    )
    assert np.isfinite(found.fun)
    assert found.fun >= _cost(world, best) - SOLVER_GAP


def _cost(world: World, standard: np.ndarray) -> float:
    system = world.system
    miss = system.target - system.triangle @ world.base.base_of(standard)
    step = (standard - world.prior.centre) / world.prior.scale
    return float((miss @ miss + PULL * step @ step) / (2.0 * system.rows))
