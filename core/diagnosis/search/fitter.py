"""Keep the rows, the causes and what is believed on one bench, and try hypotheses on it.

Columns are computed once per candidate and belief; a scan over all causes, joints and scalars is then a few
matrix products.
"""

from collections.abc import Callable, Iterable, Sequence
from copy import copy
from dataclasses import replace
from weakref import WeakKeyDictionary

import numpy as np

from ...arrays import Indices, JointSeries, JointVector
from ...dynamics.prediction import Prediction
from ...estimate.gaussian_prior import GaussianPrior
from ...regressor.columns import ColumnPlan
from ...simulation.inverse import inverse_dynamics
from ..causes.protocol import Cause
from ..dataset.dataset import Dataset
from ..regression.gls import TRIAL_ROUNDS, Fit, fit, noise_absorbs_effect, refit
from ..regression.rows import Columns, extended, rows_of_joints
from ..regression.score_test import Panel, Score, score, score_onsets
from .candidate_cache import CandidateCache, cache_at
from .candidates import Candidates, extended_prediction, no_candidates
from .hypothesis import Candidate, Hypothesis, Place, ScoredCandidate, best_of_kinds

SCORED_ANEW = 24
"""Best kinds of a scan that are scored anew where columns are of an earlier belief; fewer are ever fitted."""
TELLING = 3
"""Joints that are asked when something began."""
MOST_AT_REST = 0.9
"""A joint whose friction at rest may be anything on more than this share of the rows hardly moves."""


class HypothesisFitter:
    """Try hypotheses on the rows of a look.

    Parameters
    ----------
    dataset
        The rows; a fit may use those that are usable and not held out.
    plan
        The model's base columns.
    causes
        What is suspected.
    prior
        Normal prior of the base parameters; None where the rows alone determine them.
    """

    def __init__(
        self,
        dataset: Dataset,
        plan: ColumnPlan,
        causes: Sequence[Cause],
        prior: GaussianPrior | None = None,
    ) -> None:
        self.dataset = dataset
        self.plan = plan
        self.causes = tuple(causes)
        self.prior = prior
        columns = dataset.observed(plan)
        self.base = rows_of_joints(dataset, columns, dataset.usable & ~dataset.held_out[:, None])
        self.holdout = rows_of_joints(dataset, columns, dataset.usable & dataset.held_out[:, None])
        self.everywhere = rows_of_joints(dataset, columns, np.ones_like(dataset.usable))
        self._lasting: dict[Place, Columns] = {}
        self._panels: WeakKeyDictionary[CandidateCache, Panel] = WeakKeyDictionary()
        self._ordinary = False
        self._ranking: CandidateCache | None = None
        self._now = no_candidates(dataset, plan.model)

    def believe(self, found: Hypothesis) -> None:
        """Take a fit's base parameters for what is believed, and forget what was built on others.

        What may have happened is then looked for in what the hypothesis leaves of the torque.
        """
        standard = np.zeros(len(self.plan.model.parameters))
        standard[list(self.plan.columns)] = found.fit.values[: len(self.plan.columns)]
        operating_point = extended_prediction(
            self.dataset, found, Prediction(self.plan.model, standard, inverse_dynamics)
        )
        self._now = Candidates(self.causes, self.dataset, self._without_lasting(found), operating_point)

    def remembered(self) -> Callable[[], None]:
        """Give what brings back what is believed now, after something else was."""
        now, ranking = self._now, self._ranking

        def believe_again() -> None:
            self._now, self._ranking = now, ranking

        return believe_again

    def _without_lasting(self, found: Hypothesis) -> Dataset:
        """Take from the torque what a hypothesis's members explain of it, all but events."""
        torque = self.dataset.torque.copy()
        for index, columns in enumerate(self.columns(found.members)):
            if not found.members[index].cause.traits.transient:
                for joint, one in columns.items():
                    torque[:, joint] -= one @ found.fit.values[found.columns_of(index)]
        return replace(self.dataset, torque=torque)

    @property
    def candidates(self) -> tuple[Candidate, ...]:
        """Give everything that is suspected, as it was under earlier beliefs that rank it alike."""
        return (*self._ranked_like_now.candidates, *self._now.events)

    @property
    def _ranked_like_now(self) -> CandidateCache:
        """Give what no other belief since it was ranked would rank otherwise."""
        before, now = self._ranking, self._now
        self._ranking = cache_at(now) if before is None else before.under(now)
        return self._ranking

    @property
    def suspicion(self) -> Candidates:
        """Give what is suspected under the present belief."""
        return self._now

    @property
    def operating_point(self) -> Prediction:
        """Give what is believed: the columns of candidates are built on it."""
        return self._now.operating_point

    def scored(self, under: Hypothesis, candidates: Sequence[Candidate]) -> list[Score]:
        """Score candidates on top of a hypothesis."""
        return score(under.fit, self.base, self.columns(candidates))

    def scored_from(
        self, under: Hypothesis, candidate: Candidate, some: slice, starts: Indices
    ) -> list[Score]:
        """Score some columns of a candidate as if they acted from some row of the look on, for many rows.

        Nearly: on the joints that tell most.
        """
        (columns,) = self.columns([candidate])
        part = {joint: one[:, some] for joint, one in columns.items()}
        with_deviations = {
            joint: float(np.sum((under.fit.joints[joint].whitening @ one[self.base[joint].rows]) ** 2))
            for joint, one in part.items()
        }
        most = sorted(with_deviations, key=lambda joint: -with_deviations[joint])[:TELLING]
        return score_onsets(under.fit, self.base, {joint: part[joint] for joint in most}, starts)

    @property
    def kinds(self) -> int:
        """Count the pairs of cause and site that are suspected."""
        return max(len({one.key for one in self.candidates}), 1)

    def columns(self, candidates: Sequence[Candidate]) -> list[Columns]:
        """Give the candidates' filtered columns, computing those that are new."""
        return self._columns(candidates, self._now)

    def _columns(self, candidates: Sequence[Candidate], suspicion: Candidates) -> list[Columns]:
        known = (self._lasting, suspicion.columns)
        new = [one for one in candidates if not any(one.place in kept for kept in known)]
        terms = [
            one.cause.term(self.dataset, suspicion.operating_point, one.site, one.scalars) for one in new
        ]
        for one, term, columns in zip(new, terms, self.dataset.columns(terms), strict=True):
            known[hasattr(term, "believed")][one.place] = columns
        return [next(kept[one.place] for kept in known if one.place in kept) for one in candidates]

    def tried(self, members: tuple[Candidate, ...], start: Hypothesis | None = None) -> Hypothesis:
        """Fit a hypothesis, learning its noise anew, from where another's fit left it if one is given.

        Noise that has learned a large effect can lead to where nature does not allow it; then all noise is
        learned from the beginning.
        """
        columns = self.columns(members)
        rows = extended(self.base, columns)
        if start is not None:
            found = self._hypothesis(members, columns, refit(rows, start.fit, self.base[0].columns.shape[1]))
            if found.possible or start.members == members:
                return found
        return self._hypothesis(members, columns, fit(rows, prior=self.prior, ordinary=self._ordinary))

    def less(self, now: Hypothesis) -> tuple[Hypothesis, ...]:
        """Fit a hypothesis without each of its members in turn; kept until another's are asked for."""
        kept = self._now.less
        if now not in kept:
            kept.clear()
            rest = ((*now.members[:one], *now.members[one + 1 :]) for one in range(len(now.members)))
            kept[now] = tuple(self.tried(members, now) for members in rest)
            self._now.trials.update({one: {} for one in kept[now]})
        return kept[now]

    def added(self, start: Hypothesis, candidate: Candidate) -> Hypothesis:
        """Fit a hypothesis with one more member, learning its noise anew where the member acts.

        Where it leaves the others what nature does not allow, all noise is learned from the beginning (see
        `tried`). Where nature does not allow the new one itself, other noise hardly ever mends that.
        """
        members = (*start.members, candidate)
        columns = self.columns(members)
        rows = extended(self.base, columns)
        kept, touched = len(start.fit.values), frozenset(columns[-1])
        found = self._hypothesis(members, columns, refit(rows, start.fit, kept, touched, rounds=TRIAL_ROUNDS))
        if found.possible or not candidate.cause.admissible(found.solved(len(start.members))):
            return found
        return self.tried(members)

    def beneath(self, trial: Hypothesis, index: int) -> Hypothesis:
        """Fit a hypothesis without one member, at the noise that it has with it.

        Scalars are settled on top of this: noise that has learned the effect hardly cares what they are.
        """
        members = (*trial.members[:index], *trial.members[index + 1 :])
        kept = trial.columns_of(index).start
        columns = self.columns(members)
        found = refit(extended(self.base, columns), trial.fit, kept, rounds=0)
        return self._hypothesis(members, columns, found)

    def _hypothesis(
        self, members: tuple[Candidate, ...], columns: Sequence[Columns], found: Fit
    ) -> Hypothesis:
        return Hypothesis(
            members,
            found,
            tuple(next(iter(one.values())).shape[1] for one in columns),
            self.base[0].columns.shape[1],
        )

    def scanned(
        self, under: Hypothesis, candidates: Sequence[Candidate] | None = None
    ) -> list[ScoredCandidate]:
        """Score candidates (all by default) on top of a hypothesis; the best scalars of each kind only.

        Scalars at which nature allows what is found go before those at which it does not. What all of them
        score is kept as long as the hypothesis and the belief are.
        """
        if candidates is not None:
            return best_of_kinds(candidates, self.scored(under, candidates))
        scans = self._now.scans
        if under not in scans:
            scans[under] = self._scan(under)
        return scans[under]

    def _scan(self, under: Hypothesis) -> list[ScoredCandidate]:
        """Score everything that is suspected, the best anew where columns may be of an earlier belief."""
        ranking, events = self._ranked_like_now, self._now.events
        asked = (*ranking.candidates, *events)
        scores = [*self._panel(ranking).scores(under.fit), *self.scored(under, events)]
        found = best_of_kinds(asked, scores)
        if ranking.of(self._now):
            return found
        again = self.scanned(under, [one.candidate for one in found[:SCORED_ANEW]])
        return sorted([*again, *found[SCORED_ANEW:]], key=lambda one: one.log_p)

    def _panel(self, ranking: CandidateCache) -> Panel:
        """Give what scores all that is suspected all along the motion."""
        if ranking not in self._panels:
            self._panels[ranking] = Panel(self.base, ranking.columns(self._columns))
        return self._panels[ranking]

    def needs_ordinary_noise(self, under: Hypothesis) -> bool:
        """Tell whether a hypothesis leaves some joint's noise much more than an ordinary fit would.

        Never where noise is learned from ordinary fits already.
        """
        rows = extended(self.base, self.columns(under.members))
        return not self._ordinary and noise_absorbs_effect(rows, under.fit)

    def with_ordinary_noise(self) -> "HypothesisFitter":
        """Give a bench of the same rows with ordinary noise; what ranked candidates may rank them still."""
        other = copy(self)
        other._ordinary = True  # noqa: SLF001 - of the same class
        other._now = no_candidates(self.dataset, self.plan.model)  # noqa: SLF001 - of the same class
        return other

    def with_look(self, dataset: Dataset) -> "HypothesisFitter":
        """Give a bench of a look that holds other rows out; what ranked candidates may rank them still."""
        other = HypothesisFitter(dataset, self.plan, self.causes, self.prior)
        other._lasting, other._ranking = self._lasting, self._ranking
        return other

    def residual(self, under: Hypothesis, without: Iterable[int] = ()) -> JointSeries:
        """Give measured minus predicted torque at all rows, stuck friction taken out, N m or N.

        Parameters
        ----------
        without
            Places of members whose torque is left out of the prediction, all else kept as it is.
        """
        rows = extended(self.everywhere, self.columns(under.members))
        values = under.fit.values.copy()
        for place in without:
            values[under.columns_of(place)] = 0.0
        return np.column_stack([one.missed(values) for one in rows])

    def at_rest(self, under: Hypothesis) -> JointVector:
        """Give, per joint, the share of the residual's mean square that friction at rest accounts for.

        As far as it is more than any columns as many would take; not a number where a joint hardly moves.
        """
        shares = []
        for part in extended(self.everywhere, self.columns(under.members)):
            count, taken = len(part.torque), part.free.count
            whole = part.torque - part.columns @ under.fit.values
            left = part.missed(under.fit.values)
            ratio = float(left @ left) / max(float(whole @ whole), 1e-300)
            moves = taken < MOST_AT_REST * count
            shares.append(max(1.0 - ratio * count / (count - taken), 0.0) if moves else np.nan)
        return np.array(shares)
