"""Check a set-up: whether the stamps agree with the velocities, and which correction a doubtful fit needs."""

from dataclasses import dataclass

from ..identification.identify import Fit
from ..log.model import JointLog
from .doubt import is_doubtful
from .samples import sampled
from .search import FoundConflict, find_conflicts
from .setup import Setup
from .time_base import stamp_factor
from .trial import Trials


@dataclass(frozen=True, eq=False)
class Conflicts:
    """Hold what was found to disagree."""

    found: tuple[FoundConflict, ...] = ()
    """Conflicts that corrections remove, in the order in which they were found."""
    stamp_factors: tuple[float | None, ...] = ()
    """Per log, the factor by which its stamps' steps are too long; None where nothing contradicts them."""
    applied: bool = False
    """Whether the corrections were applied before anything else was computed."""

    @property
    def is_open(self) -> bool:
        """Tell whether something disagrees that was not corrected."""
        return (bool(self.found) and not self.applied) or any(self.stamp_factors)

    @property
    def setup(self) -> Setup | None:
        """Give the corrected set-up; None where nothing is to be corrected."""
        return self.found[-1].hypothesis.setup if self.found else None


def check(fit: Fit, logs: tuple[JointLog, ...], terms: tuple[str, ...] | None) -> Conflicts:
    """Look for conflicts where a plain fit is in doubt; stamps are always compared."""
    factors = tuple(stamp_factor(log) for log in logs)
    if not is_doubtful(fit):
        return Conflicts((), factors)
    problem = fit.problem
    trials = Trials(sampled(problem.motions, problem.held_out), terms)
    return Conflicts(find_conflicts(Setup.as_described(problem.base.model.robot), trials), factors)
