"""Hold the candidates at one operating point, and what was computed for them there."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from weakref import WeakKeyDictionary

import numpy as np

from ...arrays import JointVector
from ...dynamics.model import DynamicModel
from ...dynamics.prediction import Prediction
from ...simulation.inverse import inverse_dynamics
from ..causes.protocol import Cause, Setting, Site
from ..dataset.dataset import Dataset
from ..regression.rows import Columns
from .hypothesis import Candidate, ColumnKey, Hypothesis, ScoredCandidate, candidates_of


@dataclass(frozen=True, eq=False)
class Candidates:
    """Hold the candidates at one operating point."""

    causes: tuple[Cause, ...]
    dataset: Dataset
    left: Dataset
    """The data set; and the same with what is not explained so far in place of the torque."""
    operating_point: Prediction
    columns: dict[ColumnKey, Columns] = field(default_factory=dict)
    """The filtered columns of candidates that depend on the operating point."""
    scans: WeakKeyDictionary[Hypothesis, list[ScoredCandidate]] = field(default_factory=WeakKeyDictionary)
    """Per hypothesis, the scan of all candidates on top of it."""
    less: WeakKeyDictionary[Hypothesis, tuple[Hypothesis, ...]] = field(default_factory=WeakKeyDictionary)
    """The last hypothesis whose members were removed in turn, and the smaller hypotheses."""
    trials: WeakKeyDictionary[Hypothesis, dict[ColumnKey, Hypothesis]] = field(
        default_factory=WeakKeyDictionary
    )
    """For each of these, the hypotheses with a candidate in the removed member's place."""
    _known: dict[tuple[Cause, Site], tuple[Candidate, ...]] = field(default_factory=dict)

    @property
    def lasting(self) -> tuple[tuple[Cause, Site], ...]:
        """List the causes that act all the time, with their sites."""
        return tuple(self._sites(cause for cause in self.causes if not cause.traits.transient))

    @cached_property
    def events(self) -> tuple[Candidate, ...]:
        """Give the transient candidates, from what is not explained so far."""
        pairs = self._sites(cause for cause in self.causes if cause.traits.transient)
        return tuple(candidate for cause, site in pairs for candidate in self.of(cause, site))

    def _sites(self, causes: Iterable[Cause]) -> Iterator[tuple[Cause, Site]]:
        for cause in causes:
            for site in cause.sites(self.dataset):
                yield cause, site

    def of(self, cause: Cause, site: Site) -> tuple[Candidate, ...]:
        """Give one cause at one site with all values of its scalars."""
        if (cause, site) not in self._known:
            self._known[cause, site] = candidates_of(cause, Setting(self.left, self.operating_point, site))
        return self._known[cause, site]

    def of_kind(self, key: tuple[str, Site]) -> tuple[Candidate, ...]:
        """Give all causes of one id at one site: against a reference some come in two forms."""
        name, site = key
        causes = (cause for cause in self.causes if cause.id == name and site in cause.sites(self.dataset))
        return tuple(candidate for cause in causes for candidate in self.of(cause, site))

    def change(self, other: "Candidates") -> JointVector:
        """Give the RMS difference of another prediction, as a share of each joint's torque."""
        square, change = np.zeros(self.dataset.joints), np.zeros(self.dataset.joints)
        if other is self:
            return change
        for stretch in self.dataset.stretches:
            own, theirs = (point.operating_point.scaled(stretch.state) for point in (self, other))
            square += np.sum(own**2, axis=0)
            change += np.sum((theirs - own) ** 2, axis=0)
        return np.asarray(np.sqrt(change / np.maximum(square, 1e-300)))


def no_candidates(dataset: Dataset, model: DynamicModel) -> Candidates:
    """Give the operating point without any torque, and no candidates."""
    nothing = Prediction(model, np.zeros(len(model.parameters)), inverse_dynamics)
    return Candidates((), dataset, dataset, nothing)


def extended_prediction(dataset: Dataset, found: Hypothesis, operating_point: Prediction) -> Prediction:
    """Extend a prediction by the members: loads first, then all else, then gains of the torque channel.

    A delay acts on the result, and is not part of it.
    """
    for joins in (
        lambda term: term.loads,
        lambda term: not term.loads and not term.channel,
        lambda term: term.channel,
    ):
        terms = []
        for index, member in enumerate(found.members):
            term = member.term(dataset, operating_point)
            if joins(term) and not member.cause.traits.self_consistent:
                terms.append((term, found.fit.values[found.columns_of(index)]))
        operating_point = operating_point.joined_by(terms)
    return operating_point
