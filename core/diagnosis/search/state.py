"""Hold the state of a search as one value: the hypothesis, its operating point, and how it got there."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from ..causes.protocol import Site
from .fitter import HypothesisFitter
from .hypothesis import Candidate, Hypothesis

Key = tuple[str, Site]
"""A kind of candidate: cause and site."""
Keys = frozenset[Key]
"""The kinds of a hypothesis's members."""
Excluded = Mapping[Key, float]
"""Kinds that were dropped, and the likelihood ratio statistic from which on each may enter again."""


@dataclass(frozen=True, eq=False)
class Step:
    """Record one decision of the search, for the report."""

    action: str
    candidate: Candidate
    statistic: float


@dataclass(frozen=True, eq=False)
class SearchState:
    """Hold the state of a search."""

    fitter: HypothesisFitter
    """The fitter at the operating point of the chosen hypothesis."""
    none: Hypothesis
    chosen: Hypothesis
    """The empty hypothesis, and the one that the search has come to."""
    steps: tuple[Step, ...] = ()
    through: frozenset[Keys] = frozenset()
    """The decisions so far, and the sets of causes that the search came through."""
    excluded: Excluded = field(default_factory=dict)
    """Kinds that were dropped on the way."""

    @property
    def keys(self) -> Keys:
        """Give the kinds of the chosen hypothesis's members."""
        return frozenset(self.chosen.by_key)

    def at(self, fitter: HypothesisFitter, chosen: Hypothesis) -> "SearchState":
        """Give the state with another hypothesis and operating point."""
        return replace(self, fitter=fitter, chosen=chosen)

    def linearised_at(self, chosen: Hypothesis) -> "SearchState":
        """Give the state with a hypothesis, linearised there and fitted again to the columns there."""
        fitter = self.fitter.linearised_at(chosen)
        return self.at(fitter, fitter.fit(chosen.members, chosen))

    def recorded(self, action: str, candidate: Candidate, statistic: float) -> "SearchState":
        """Give the state with one more decision on record."""
        return replace(self, steps=(*self.steps, Step(action, candidate, statistic)))

    def excluding(self, key: Key, unless_above: float = np.inf) -> "SearchState":
        """Give the state in which a kind may not enter again, unless it brings more than a statistic."""
        return replace(self, excluded={**self.excluded, key: unless_above})
