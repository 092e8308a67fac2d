"""The seed's criterion by Nelder-Mead: squared torque error, and a wall where M(q) is not positive.

It is minimised over the same weighted equations as the semidefinite programme, from the same prior, with the
mass matrix checked along the trajectory only, as the seed paper does. Source: the seed paper, section 3.
"""

import time
from dataclasses import dataclass

import numpy as np
from scipy import optimize

from benchmarks.demo_log import demo_log, demo_robot
from benchmarks.figures import Figure, processor_seconds
from veritorque.core.document.identification import Identification
from veritorque.core.estimate.estimate import estimate
from veritorque.core.estimate.feasibility import feasibility
from veritorque.core.estimate.options import EstimateOptions
from veritorque.core.study import IdentifyRequest, identify_in_full
from veritorque.core.validation.mass_matrix import mass_matrices

EVALUATIONS = 20_000
POSITIONS = 40


def run(*, quick: bool) -> list[Figure]:
    """Minimise, and compare objective, time and existence with the programme's."""
    found = identify_in_full(IdentifyRequest(demo_robot(), (demo_log(),), {"bootstrap": {"draws": 0}}))
    answer = found.estimate
    criterion = Criterion.of(found)
    evaluations = 300 if quick else EVALUATIONS
    begin = time.process_time()
    start = found.base.base_of(answer.prior.centre) / criterion.scale
    reached = optimize.minimize(
        criterion, start, method="Nelder-Mead", options={"maxfev": evaluations, "adaptive": True}
    )
    spent = time.process_time() - begin
    options = EstimateOptions()
    programme = processor_seconds(
        lambda: estimate(found.base, answer.system, answer.prior, options), repeats=3
    )
    values = reached.x * criterion.scale
    exists = feasibility(found.base, values, answer.prior)
    rows = answer.system.rows
    return [
        Figure(
            f"objective after {evaluations} evaluations over the programme's",
            f"{answer.system.cost(values) / answer.objective:.2f}",
            ">= 1",
            f"per equation: {answer.system.cost(values) / rows:.3f} and {answer.objective / rows:.3f}",
            ratio=True,
        ),
        Figure(
            "processor time over the programme's",
            f"{spent / programme:.0f}",
            "",
            f"{spent:.1f} s and {1e3 * programme:.1f} ms",
            ratio=True,
        ),
        Figure(
            "can its answer be a robot", "yes" if exists.feasible else "no", "", f"margin {exists.margin:.2e}"
        ),
        Figure("can the programme's", "yes" if found.estimate_feasibility.feasible else "no", "yes"),
    ]


@dataclass(frozen=True, eq=False)
class Criterion:
    """Give the seed's criterion as a function of scaled base parameters.

    Attributes
    ----------
    scale
        What counts as one unit, per base parameter.
    mass_matrix
        Mass matrix per unit base parameter at positions of the trajectory: base x (positions joints joints).
    """

    found: Identification
    scale: np.ndarray
    mass_matrix: np.ndarray

    @classmethod
    def of(cls, found: Identification) -> "Criterion":
        """Prepare what every evaluation needs."""
        base, positions = found.base, found.observation.positions
        chosen = positions[:: max(1, len(positions) // POSITIONS)]
        units = np.eye(len(base.model.parameters))[list(base.kept)]
        matrices = np.array([mass_matrices(base.model, unit, chosen) for unit in units])
        scale = np.linalg.norm(base.grouping * found.estimate.prior.scale, axis=1)
        return cls(found, scale, matrices)

    def __call__(self, scaled: np.ndarray) -> float:
        """Give the weighted squared torque error, or a wall that leads back where M(q) is not positive."""
        values = scaled * self.scale
        smallest = np.linalg.eigvalsh(np.tensordot(values, self.mass_matrix, axes=1))[:, 0].min()
        system = self.found.estimate.system
        cost = system.cost(values)
        return cost if smallest > 0.0 else 10.0 * (cost + system.cost(0.0 * values)) * (1.0 - smallest)
