"""Hold conflicts that were found one after the other, each beside the corrections before it."""

from dataclasses import dataclass

from .conflict import Hypothesis
from .thresholds import DECISION
from .trial import Outcome


@dataclass(frozen=True, eq=False)
class FoundConflict:
    """Hold a conflict that was found, and what it was compared with."""

    hypothesis: Hypothesis
    before: Outcome
    after: Outcome
    confidence: float
    """Probability that it, or one of those it cannot be told apart from, is the right correction."""
    equivalents: tuple[Hypothesis, ...]
    """Hypotheses of other kinds or joints that predict as well."""


Path = tuple[FoundConflict, ...]


def cost(path: Path) -> float:
    """Give the last error, to which each correction that is not expected adds what one has to gain."""
    return path[-1].after.score + DECISION.least_gain * sum(not step.hypothesis.expected for step in path)
