"""Hold what a log is compared with: the base parameters of a simulation, and how well they are known.

What has changed since an earlier identification, or against a description that brings its own bodies, shows
only where the base parameters are not free to follow it. They are normally distributed about the reference's;
that is a set of white equations more. Source: Gelman et al., Bayesian Data Analysis (2013), ch. 14 (prior
information as additional data).
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import null_space, qr, solve_triangular

from ..arrays import BaseParameters, EquationRows, LinkParameters, LinkTable, Matrix, Parameters
from ..errors import RobotError
from ..estimate.constraints import link_columns
from ..estimate.gaussian_prior import GaussianPrior
from ..estimate.system import RANK_TOLERANCE, System, column_scale
from ..reduction.base import BaseModel
from ..robot.inertia import link_parameters, pseudo_inertia

PRIOR = "prior"
"""The name of the reference that is the robot's own description."""
LEAST_DEVIATION = 0.005
"""No parameter is taken to be known better than this share of itself: so far two logs of one robot disagree
by what the model leaves out, which the noise of neither tells."""
PRIOR_DEVIATION = 0.02
"""Of a description's bodies: every entry of a pseudo-inertia is off by this share of the roots of its
diagonal."""


@dataclass(frozen=True, eq=False)
class Reference:
    """Hold a simulation that a log is compared with."""

    name: str
    """What it is called in documents."""
    base: BaseModel
    """Its model and base parameters."""
    standard: Parameters
    """Its standard parameters."""
    values: BaseParameters
    """Its base parameters."""
    rows: Matrix
    """Equations over the base parameters whose error has unit variance; directions in which it tells nothing
    have none."""

    @property
    def prior(self) -> GaussianPrior:
        """Give it as equations."""
        return GaussianPrior(self.rows, self.rows @ self.values)

    @property
    def left_open(self) -> tuple[str, ...]:
        """Name the base parameters of which it tells nothing by themselves."""
        known = np.abs(self.rows).max(axis=0, initial=0.0)
        return tuple(
            name for name, size in zip(self.base.names, known, strict=True) if size <= 1e-12 * known.max()
        )

    def completed(self, system: System) -> BaseParameters:
        """Give its base parameters, what it leaves open filled in from a log's equations.

        A description that tells nothing of friction is judged with the log's friction.
        """
        scale = column_scale(self.rows)
        free = null_space(self.rows / scale) / scale[:, None]
        missed = system.target - system.triangle @ self.values
        step, *_ = np.linalg.lstsq(system.triangle @ free, missed, rcond=RANK_TOLERANCE)
        return np.asarray(self.values + free @ step)


def with_least_deviation(rows: Matrix, values: BaseParameters, share: float = LEAST_DEVIATION) -> Matrix:
    """Add to what is known of parameters an independent deviation of a share of each of them.

    Examples
    --------
    Known to 0.003 of 1, with a further deviation of 0.004 of it, one is known to 0.005:

    >>> with_least_deviation(np.array([[1.0 / 0.003]]), np.array([1.0]), 0.004).round(6)
    array([[200.]])
    """
    spread = rows * (share * np.abs(values))
    whole = np.hstack([np.eye(len(rows)), spread])
    triangle = qr(whole.T, mode="r")[0][: len(rows)]
    return np.asarray(solve_triangular(triangle * np.sign(np.diag(triangle))[:, None], rows, trans="T"))


def reference_from_prior(base: BaseModel) -> Reference:
    """Take a robot's own bodies for the reference; what they do not tell (friction, rotors) is left open.

    Raises
    ------
    RobotError
        If the description brings no bodies, or the model has none.
    """
    bodies, links = base.model.robot.prior, link_columns(base.model)
    if bodies is None or not links:
        raise RobotError(
            "the robot has no prior to be compared with",
            evidence={"robot": base.model.robot.name, "prior": None, "links": len(links)},
            remedy="describe the robot with the inertial parameters of its links, or name a job as reference",
        )
    standard = np.zeros(len(base.model.parameters))
    spread: list[EquationRows] = []
    known: set[int] = set()
    for body, columns in zip(bodies, links, strict=True):
        standard[list(columns)] = body
        known |= set(columns)
        spread.append(base.grouping[:, list(columns)] @ body_spread(body))
    unknown = [column for column in range(len(standard)) if column not in known]
    combinations = null_space(base.grouping[:, unknown].T).T if unknown else np.eye(len(base.kept))
    values = base.base_of(standard)
    return Reference(PRIOR, base, standard, values, _whiten(combinations, np.hstack(spread)))


def body_spread(body: LinkParameters, deviation: float = PRIOR_DEVIATION) -> EquationRows:
    """Give the directions in which a body's ten parameters are off, each by one standard deviation.

    Every entry of its pseudo-inertia is off by a share of the roots of its diagonal.
    """
    root = np.sqrt(np.maximum(np.diag(pseudo_inertia(body)), 0.0))
    directions = []
    for row in range(4):
        for column in range(row, 4):
            entry = np.zeros((4, 4))
            entry[row, column] = entry[column, row] = deviation * root[row] * root[column]
            directions.append(link_parameters(entry))
    return np.array(directions).T


def bodies_spread(rows: EquationRows, bodies: LinkTable, deviation: float) -> EquationRows:
    """Give the directions of all bodies in equations over their parameters, ten columns each."""
    spread = [
        rows[:, 10 * link : 10 * link + 10] @ body_spread(body, deviation) for link, body in enumerate(bodies)
    ]
    return np.hstack(spread)


def _whiten(combinations: EquationRows, spread: EquationRows) -> EquationRows:
    """Give combinations of base parameters in units of their deviation; those without one are left out."""
    values, vectors = np.linalg.eigh(combinations @ spread @ spread.T @ combinations.T)
    kept = values > 1e-12 * max(float(values[-1]), 1e-300) if len(values) else np.zeros(0, dtype=bool)
    return np.asarray((vectors[:, kept] / np.sqrt(values[kept])).T @ combinations)
