"""Fit hypotheses to the rows of a data set, with all columns linearised at one operating point.

A fitter is a value: moving the operating point gives another fitter and leaves the first unchanged.
Columns are kept by the operating point that they are linearised at, so that a scan over all causes, joints
and scalars is a few matrix products.
"""

from collections import ChainMap
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from weakref import WeakKeyDictionary

import numpy as np

from ...arrays import Indices, JointSeries
from ...dynamics.prediction import Prediction
from ...dynamics.term import is_linearised
from ...estimate.gaussian_prior import GaussianPrior
from ...regressor.columns import ColumnPlan
from ...simulation.inverse import inverse_dynamics
from ..causes.protocol import Cause
from ..dataset.dataset import Dataset
from ..regression.gls import Fit, fit, noise_absorbs_effect, refit
from ..regression.rows import Columns, append_columns
from ..regression.score_test import Panel, Score, score, score_onsets
from ..thresholds.regression import NOISE
from ..thresholds.search import REFINEMENT, SEARCH
from .candidate_cache import CandidateCache, cache_at
from .candidates import Candidates, extended_prediction, no_candidates
from .fit_rows import FitRows
from .hypothesis import Candidate, ColumnKey, Hypothesis, ScoredCandidate, best_of_kinds


@dataclass(frozen=True, eq=False)
class HypothesisFitter:
    """Fit hypotheses at one operating point."""

    dataset: Dataset
    rows: FitRows
    """The data set and its rows per joint; a fit uses those that are usable and not held out."""
    plan: ColumnPlan
    """The model's base columns."""
    causes: tuple[Cause, ...]
    """The candidate causes."""
    prior: GaussianPrior | None
    """Prior of the base parameters; None where the rows alone determine them."""
    at: Candidates
    """The candidates, with their columns, at the operating point."""
    ordinary_noise: bool = False
    """Whether noise is estimated from the residual of ordinary least squares."""
    earlier: CandidateCache | None = None
    """The candidate cache of an earlier operating point, if one was made."""
    _fixed_columns: dict[ColumnKey, Columns] = field(default_factory=dict)
    _panels: WeakKeyDictionary[CandidateCache, Panel] = field(default_factory=WeakKeyDictionary)
    _none: dict[bool, Hypothesis] = field(default_factory=dict)
    _absorbed: WeakKeyDictionary[Hypothesis, bool] = field(default_factory=WeakKeyDictionary)

    def linearised_at(self, found: Hypothesis) -> "HypothesisFitter":
        """Give a fitter whose operating point is what a hypothesis predicts.

        Transient causes are then searched in what the hypothesis leaves of the torque.
        """
        standard = np.zeros(len(self.plan.model.parameters))
        standard[list(self.plan.columns)] = found.fit.values[: len(self.plan.columns)]
        plain = Prediction(self.plan.model, standard, inverse_dynamics)
        point = extended_prediction(self.dataset, found, plain)
        left = self._without_lasting_causes(found)
        return replace(
            self, at=Candidates(self.causes, self.dataset, left, point), earlier=self._latest_cache
        )

    def with_ordinary_noise(self) -> "HypothesisFitter":
        """Give a fitter of the same rows that estimates noise from ordinary residuals, without candidates."""
        nothing = no_candidates(self.dataset, self.plan.model)
        return replace(self, at=nothing, ordinary_noise=True, earlier=self._latest_cache)

    def with_causes(self, causes: Sequence[Cause], prior: GaussianPrior | None) -> "HypothesisFitter":
        """Give a fitter of the same rows that knows candidate causes, and a prior."""
        none = self._none if prior is None and self.prior is None else {}
        return replace(self, causes=tuple(causes), prior=prior, ordinary_noise=False, _none=none)

    def with_dataset(self, dataset: Dataset) -> "HypothesisFitter":
        """Give a fitter of a data set that holds other rows out; columns and candidate cache stay of use."""
        return HypothesisFitter(
            dataset,
            FitRows(dataset, self.rows.columns),
            self.plan,
            self.causes,
            self.prior,
            no_candidates(dataset, self.plan.model),
            earlier=self._latest_cache,
            _fixed_columns=self._fixed_columns,
        )

    def with_torque(self, torque: JointSeries) -> "HypothesisFitter":
        """Give a fitter of the same rows with another torque, for fits; its candidates stay as they are."""
        rows = self.rows.with_torque(torque)
        return replace(
            self,
            dataset=replace(self.dataset, torque=torque),
            rows=rows,
            _none={},
            _absorbed=WeakKeyDictionary(),
        )

    @property
    def operating_point(self) -> Prediction:
        """Give the prediction that the columns of candidates are linearised at."""
        return self.at.operating_point

    @property
    def candidates(self) -> tuple[Candidate, ...]:
        """Give all candidates, those that act all the time as the candidate cache has them."""
        return (*self.cache.candidates, *self.at.events)

    @cached_property
    def cache(self) -> CandidateCache:
        """Give the candidates whose columns at an earlier operating point are still near enough."""
        return cache_at(self.at) if self.earlier is None else self.earlier.under(self.at)

    @property
    def _latest_cache(self) -> CandidateCache | None:
        """Give the cache, or the earlier one where nothing was scanned here: then none is made."""
        return self.__dict__.get("cache", self.earlier)

    @property
    def kinds(self) -> int:
        """Count the pairs of cause and site among the candidates."""
        return max(len({candidate.key for candidate in self.candidates}), 1)

    def columns(self, candidates: Sequence[Candidate]) -> list[Columns]:
        """Give the candidates' filtered columns, computing those that are new."""
        return self._columns(candidates, self.at)

    def _columns(self, candidates: Sequence[Candidate], at: Candidates) -> list[Columns]:
        known = ChainMap(self._fixed_columns, at.columns)
        new = [each for each in candidates if each.column_key not in known]
        terms = [each.term(self.dataset, at.operating_point) for each in new]
        for candidate, term, columns in zip(new, terms, self.dataset.columns(terms), strict=True):
            known.maps[is_linearised(term)][candidate.column_key] = columns
        return [known[each.column_key] for each in candidates]

    def _without_lasting_causes(self, found: Hypothesis) -> Dataset:
        """Take from the torque what a hypothesis's members explain of it, all but transient ones."""
        torque = self.dataset.torque.copy()
        for index, columns in enumerate(self.columns(found.members)):
            if not found.members[index].cause.traits.transient:
                for joint, own in columns.items():
                    torque[:, joint] -= own @ found.fit.values[found.columns_of(index)]
        return replace(self.dataset, torque=torque)

    def score(self, under: Hypothesis, candidates: Sequence[Candidate]) -> list[Score]:
        """Score candidates on top of a hypothesis."""
        return score(under.fit, self.rows.fitted, self.columns(candidates))

    def score_onsets(
        self, under: Hypothesis, candidate: Candidate, some: slice, starts: Indices
    ) -> list[Score]:
        """Score some columns of a candidate that act from one of many rows on.

        Only the joints on which they are largest are used.
        """
        (columns,) = self.columns([candidate])
        part = {joint: own[:, some] for joint, own in columns.items()}
        size = {
            joint: float(np.sum(under.fit.joints[joint].white(own[self.rows.fitted[joint].rows]) ** 2))
            for joint, own in part.items()
        }
        largest = sorted(size, key=lambda joint: -size[joint])[: REFINEMENT.onset_joints]
        return score_onsets(under.fit, self.rows.fitted, {joint: part[joint] for joint in largest}, starts)

    def scan(self, under: Hypothesis, candidates: Sequence[Candidate] | None = None) -> list[ScoredCandidate]:
        """Score candidates (all by default) on top of a hypothesis; the best scalars of each kind only.

        Scalars at which the result is admissible go before those at which it is not.
        """
        if candidates is not None:
            return best_of_kinds(candidates, self.score(under, candidates))
        scans = self.at.scans
        if under not in scans:
            scans[under] = self._scan(under)
        return scans[under]

    def _scan(self, under: Hypothesis) -> list[ScoredCandidate]:
        """Score all candidates, the best again where columns may be of an earlier operating point."""
        asked = (*self.cache.candidates, *self.at.events)
        scores = [*self._panel.scores(under.fit), *self.score(under, self.at.events)]
        found = best_of_kinds(asked, scores)
        if self.cache.of(self.at):
            return found
        again = self.scan(under, [scored.candidate for scored in found[: SEARCH.scored_anew]])
        return sorted([*again, *found[SEARCH.scored_anew :]], key=lambda scored: scored.log_p)

    @property
    def _panel(self) -> Panel:
        """Give what scores all candidates that act all the time."""
        if self.cache not in self._panels:
            self._panels[self.cache] = Panel(self.rows.fitted, self.cache.columns(self._columns))
        return self._panels[self.cache]

    def fit(self, members: tuple[Candidate, ...], start: Hypothesis | None = None) -> Hypothesis:
        """Fit a hypothesis and its noise, from where another's fit left it if one is given.

        Noise that has absorbed a large effect can lead to an inadmissible result; then all noise is estimated
        from the beginning.
        """
        if start is None and not members:
            return self._fit_none()
        columns = self.columns(members)
        rows = append_columns(self.rows.fitted, columns)
        if start is not None:
            found = self._hypothesis(members, columns, refit(rows, start.fit, self._base_columns))
            if found.admissible or start.members == members:
                return found
        return self._hypothesis(members, columns, fit(rows, prior=self.prior, ordinary=self.ordinary_noise))

    def _fit_none(self) -> Hypothesis:
        """Fit the hypothesis without members, which no operating point changes, once."""
        if self.ordinary_noise not in self._none:
            found = fit(self.rows.fitted, prior=self.prior, ordinary=self.ordinary_noise)
            self._none[self.ordinary_noise] = self._hypothesis((), (), found)
        return self._none[self.ordinary_noise]

    def fit_without_each(self, now: Hypothesis) -> tuple[Hypothesis, ...]:
        """Fit a hypothesis without each of its members in turn; kept until another's are asked for."""
        kept = self.at.less
        if now not in kept:
            kept.clear()
            rest = ((*now.members[:index], *now.members[index + 1 :]) for index in range(len(now.members)))
            kept[now] = tuple(self.fit(members, now) for members in rest)
            self.at.trials.update({smaller: {} for smaller in kept[now]})
        return kept[now]

    def fit_with(self, start: Hypothesis, candidate: Candidate) -> Hypothesis:
        """Fit a hypothesis with one more member, and the noise anew where the member acts.

        Where it makes the others inadmissible, all noise is estimated from the beginning (see `fit`). Where
        the new one itself is inadmissible, other noise hardly ever changes that.
        """
        members = (*start.members, candidate)
        columns = self.columns(members)
        rows = append_columns(self.rows.fitted, columns)
        kept, touched = len(start.fit.values), frozenset(columns[-1])
        found = self._hypothesis(
            members, columns, refit(rows, start.fit, kept, touched, rounds=NOISE.trial_rounds)
        )
        if found.admissible or not candidate.cause.admissible(found.solved(len(start.members))):
            return found
        return self.fit(members)

    def fit_without(self, trial: Hypothesis, index: int) -> Hypothesis:
        """Fit a hypothesis without one member, at the noise that it has with it.

        Scalars are refined on top of this: noise that has absorbed the effect hardly depends on them.
        """
        members = (*trial.members[:index], *trial.members[index + 1 :])
        kept = trial.columns_of(index).start
        columns = self.columns(members)
        return self._hypothesis(
            members, columns, refit(append_columns(self.rows.fitted, columns), trial.fit, kept, rounds=0)
        )

    @property
    def _base_columns(self) -> int:
        return self.rows.fitted[0].size

    def _hypothesis(
        self, members: tuple[Candidate, ...], columns: Sequence[Columns], found: Fit
    ) -> Hypothesis:
        widths = tuple(next(iter(own.values())).shape[1] for own in columns)
        return Hypothesis(members, found, widths, self._base_columns)

    def needs_ordinary_noise(self, under: Hypothesis) -> bool:
        """Tell whether a hypothesis leaves some joint's noise much more than an ordinary fit would.

        Never where noise is estimated from ordinary residuals already.
        """
        if self.ordinary_noise:
            return False
        if under not in self._absorbed:
            rows = append_columns(self.rows.fitted, self.columns(under.members))
            self._absorbed[under] = noise_absorbs_effect(rows, under.fit)
        return self._absorbed[under]


def hypothesis_fitter(
    dataset: Dataset, plan: ColumnPlan, causes: Sequence[Cause], prior: GaussianPrior | None = None
) -> HypothesisFitter:
    """Prepare the rows of a data set, with no operating point and no candidates yet."""
    rows = FitRows(dataset, dataset.observed(plan))
    return HypothesisFitter(dataset, rows, plan, tuple(causes), prior, no_candidates(dataset, plan.model))
