"""Check a set-up: whether the stamps agree with the velocities, and which correction a doubtful fit needs."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ..estimate.problem import Problem
from ..log.model import JointLog
from .time_base import stamp_factor

if TYPE_CHECKING:
    from .path import FoundConflict, Path
    from .setup import Setup
    from .time_offset import TimeOffset


@dataclass(frozen=True, eq=False)
class Conflicts:
    """Hold what was found to disagree."""

    found: "tuple[FoundConflict, ...]" = ()
    """Conflicts that corrections remove, in the order in which they were found."""
    stamp_factors: tuple[float | None, ...] = ()
    """Per log, the factor by which its stamps' steps are too long; None where nothing contradicts them."""
    offsets: "tuple[TimeOffset | None, ...]" = ()
    """Per log, by how much its torques come later than its positions; None where they do not."""
    of_logs: "tuple[Path, ...]" = ()
    """Per log, what is wrong with it alone while another is right; empty where nothing is."""
    applied: bool = False
    """Whether the corrections were applied before anything else was computed."""
    searched: bool = True
    """Whether anything was in doubt, so that corrections were searched."""
    promising: float = 0.0
    """By how much the mean logarithm of the joints' errors falls under the best other set-up, where too few
    rows judge it to call it a conflict, or forces that follow positions predict better; 0 where that is less
    than a conflict has to gain."""

    @property
    def is_open(self) -> bool:
        """Tell whether something disagrees that was not corrected."""
        return (bool(self.found) and not self.applied) or any(
            (*self.stamp_factors, *self.offsets, *self.of_logs)
        )

    @property
    def confidence(self) -> float:
        """Give the probability of the corrections that were applied; 1 where none was."""
        return min((step.confidence for step in self.found if self.applied), default=1.0)

    @property
    def as_unsure(self) -> "Conflicts":
        """Give the same where what was found is no more likely than not."""
        from .path import unsure

        return replace(self, found=unsure(self.found))

    @property
    def doubtful_causes(self) -> frozenset[str]:
        """Name the causes that stay doubtful although the log was corrected."""
        from .registry import CONFLICTS

        kinds = (CONFLICTS[step.hypothesis.conflict] for step in self.found)
        return frozenset().union(*(kind.doubtful_causes for kind in kinds))

    @property
    def setup(self) -> "Setup | None":
        """Give the corrected set-up; None where nothing is to be corrected."""
        return self.found[-1].hypothesis.setup if self.found else None


def check(
    problem: Problem, logs: tuple[JointLog, ...], terms: tuple[str, ...] | None, *, doubted: bool
) -> Conflicts:
    """Look for conflicts where something is in doubt (see `is_doubtful`); stamps are always compared."""
    factors = tuple(stamp_factor(log) for log in logs)
    if not doubted:
        return Conflicts((), factors, searched=False)
    from .doubted import search_conflicts  # half of all conflicts' modules, and scipy.optimize

    return search_conflicts(problem, terms, factors)
