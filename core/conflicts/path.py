"""Hold conflicts that were found one after the other, and compare what they lead to."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from .conflict import Hypothesis
from .thresholds import DECISION
from .trial import Outcome, Trials


@dataclass(frozen=True, eq=False)
class FoundConflict:
    """Hold a conflict that was found, and what it was compared with."""

    hypothesis: Hypothesis
    before: Outcome
    after: Outcome
    confidence: float
    """Probability that it, or one of those it cannot be distinguished from, is the right correction."""
    equivalents: tuple[Hypothesis, ...]
    """Hypotheses of other kinds or joints that predict as well."""


Path = tuple[FoundConflict, ...]


def cost(path: Path) -> float:
    """Give the last error, to which each correction that is not expected adds what one has to gain."""
    return path[-1].after.score + price([step.hypothesis for step in path])


def price(corrections: Sequence[Hypothesis]) -> float:
    """Give what the size of each that is not expected has to gain, all together."""
    return DECISION.least_gain * sum(own.corrections for own in corrections if not own.expected)


def unsure(path: Path) -> Path:
    """Limit the confidence of all corrections."""
    most = DECISION.most_where_unsure
    return tuple(replace(step, confidence=min(step.confidence, most)) for step in path)


@dataclass(frozen=True)
class Margins:
    """Hold the differences of scores (mean logarithms of errors) that are significant."""

    independent: float
    """Independent values that judge."""

    @classmethod
    def of(cls, present: Outcome, trials: Trials) -> "Margins":
        """Count the independent values of all joints."""
        return cls(trials.samples.independent * len(present.errors))

    @property
    def undecided(self) -> float:
        """Give the difference below which neither of two is preferred."""
        return 0.5 * DECISION.undecided / self.independent

    @property
    def equal(self) -> float:
        """Give the difference below which two predict alike."""
        return 0.5 * DECISION.equal / self.independent

    def needed(self, tried: int) -> float:
        """Give what the best of so many has to gain: more than chance and their number explain."""
        chance = self.undecided + np.log(max(tried, 1)) / self.independent
        return max(DECISION.least_gain, float(chance))

    def likelihood(self, worse: float) -> float:
        """Give the likelihood of a score that is worse by this, over that of the other."""
        return float(np.exp(-self.independent * worse))
