"""Hold candidates, and the hypotheses that are made of them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ...arrays import SquareMatrix, Vector
from ...dynamics.prediction import Prediction
from ...dynamics.term import Term
from ...numerics.chi2_tail import log_chi2_tail
from ...robot.joint_units import is_prismatic
from ...robot.model import RobotModel
from ..causes.protocol import Cause, FittedCause, Scalars, Setting, Site
from ..dataset.dataset import Dataset
from ..regression.gls import Fit
from ..regression.score_test import Score
from ..thresholds.regression import COLUMNS
from ..thresholds.search import ENTRY

ColumnKey = tuple[str, Site, tuple[tuple[str, float], ...]]
"""A cause, its site and its scalars: the key of cached columns."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """Hold one cause at one site with values of its scalars."""

    cause: Cause
    site: Site
    scalars: Scalars
    trials: float
    """How many grid points its kind was given: what its p-value is corrected for."""
    deviations: Scalars = field(default_factory=dict)
    slopes: Mapping[str, Vector] = field(default_factory=dict)
    """Standard deviations of the scalars, as far as they were refined, and by how much the linear parameters
    change with them."""

    @property
    def key(self) -> tuple[str, Site]:
        """Name the kind: cause and site, whatever the scalars."""
        return self.cause.id, self.site

    @property
    def searched(self) -> int:
        """Count the scalars that were free."""
        return len(set(self.scalars) - set(self.cause.traits.self_consistent))

    @cached_property
    def column_key(self) -> ColumnKey:
        """Give the key of its columns."""
        return self.cause.id, self.site, tuple(sorted(self.scalars.items()))

    def term(self, dataset: Dataset, operating_point: Prediction) -> Term:
        """Give its torque per unit of its linear parameters."""
        return self.cause.term(Setting(dataset, operating_point, self.site, self.scalars))


def candidates_of(cause: Cause, at: Setting) -> tuple[Candidate, ...]:
    """Give a cause at one site with all values of its scalars."""
    grid = tuple(cause.grid(at))
    return tuple(Candidate(cause, at.site, scalars, cause.traits.trials(grid, scalars)) for scalars in grid)


@dataclass(frozen=True, eq=False)
class ScoredCandidate:
    """Hold a candidate with its score test."""

    candidate: Candidate
    statistic: float
    freedom: int
    values: Vector
    clear_share: float
    determined: bool = True
    """Whether the rows leave one of its linear parameters less open than the largest size of its cause.
    Otherwise the structure of robot and motion does not let the log show it at all."""

    @property
    def identifiable(self) -> bool:
        """Tell whether the model's parameters cannot stand for it."""
        return self.determined and self.clear_share >= ENTRY.least_clear

    @cached_property
    def log_p(self) -> float:
        """Give the logarithm of its p-value, corrected for its grid: times the number of trials."""
        return log_chi2_tail(self.statistic, self.freedom) + float(np.log(self.candidate.trials))


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """Hold some candidates with the fit of all of them together."""

    members: tuple[Candidate, ...]
    fit: Fit
    widths: tuple[int, ...]
    base: int

    def columns_of(self, index: int) -> slice:
        """Say where a member's linear parameters stand among the fit's values."""
        start = self.base + sum(self.widths[:index])
        return slice(start, start + self.widths[index])

    def freedom(self, index: int) -> int:
        """Count the directions of a member's linear parameters that the rows determine."""
        own = self.columns_of(index)
        scale = self.fit.scale[own]
        spread = np.linalg.eigvalsh(self.fit.covariance[own, own] * np.outer(scale, scale))
        return max(int(np.count_nonzero(spread < 1.0 / COLUMNS.least_clear)), 1)

    def covariance(self, index: int) -> SquareMatrix:
        """Give the covariance of a member's linear parameters where its scalars are what they are."""
        own = self.columns_of(index)
        return np.asarray(self.fit.covariance[own, own])

    def solved(self, index: int) -> FittedCause:
        """Give a member's estimates; deviations include those of its scalars and the linearisation error."""
        member, values = self.members[index], self.fit.values[self.columns_of(index)]
        covariance = self.covariance(index) + np.diag((member.cause.traits.linearisation_error * values) ** 2)
        for name, slope in member.slopes.items():
            if np.isfinite(member.deviations[name]):
                covariance += np.outer(slope, slope) * member.deviations[name] ** 2
        return FittedCause(member.site, values, covariance, member.scalars, dict(member.deviations))

    def in_joint_units(self, index: int, robot: RobotModel) -> FittedCause:
        """Give a member's estimates in the units of its joint."""
        found = self.solved(index)
        return replace(found, slides=bool(found.site) and is_prismatic(robot, found.site[0]))

    @property
    def admissible(self) -> bool:
        """Tell whether all members are physically admissible."""
        return all(self.admits(index) for index in range(len(self.members)))

    def admits(self, index: int) -> bool:
        """Tell whether one member is physically admissible."""
        return self.members[index].cause.admissible(self.solved(index))

    @property
    def by_key(self) -> Mapping[tuple[str, Site], int]:
        """Find members by kind."""
        return {member.key: index for index, member in enumerate(self.members)}


def admits(candidate: Candidate, judged: Score) -> bool:
    """Tell whether the estimates of a score test are physically admissible."""
    solved = FittedCause(candidate.site, judged.values, judged.covariance, candidate.scalars, {})
    return candidate.cause.admissible(solved)


def is_determined(cause: Cause, judged: Score) -> bool:
    """Tell whether some linear parameter is less uncertain than the largest size that its cause can have.

    A column of rounding errors, as of the encoder's zero of a vertical first joint, has a share that no other
    column spans, too. Its size may then be anything.
    """
    variances = np.diag(judged.covariance)
    return bool(np.any(variances < cause.traits.largest**2))


def best_of_kinds(asked: Sequence[Candidate], found: Sequence[Score]) -> list[ScoredCandidate]:
    """Give the best scalars of each kind, the smallest p-value first."""
    kinds: dict[object, list[int]] = {}
    for index, candidate in enumerate(asked):
        kinds.setdefault(candidate.key, []).append(index)
    best = []
    for indices in kinds.values():
        ranked = sorted(indices, key=lambda index: -found[index].statistic)
        likeliest = next((index for index in ranked if admits(asked[index], found[index])), ranked[0])
        judged = found[likeliest]
        best.append(
            ScoredCandidate(
                asked[likeliest],
                judged.statistic,
                judged.freedom,
                judged.values,
                judged.clear_share,
                is_determined(asked[likeliest].cause, judged),
            )
        )
    return sorted(best, key=lambda scored: scored.log_p)
