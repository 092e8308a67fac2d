"""Say which causes a log can show, from which size on, and which it can distinguish, without a search.

What a cause adds to the torque is prewhitened, and projected on the complement of the model's columns. A
cause of which nothing is left needs another motion. Two causes on the same joint of which nearly the same is
left explain each other. Both follow from the motion and the noise alone. Source: Rao 1948 (score test);
Bjorck & Golub 1973 (angles between subspaces).
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, combinations, pairwise, product
from typing import Literal

import numpy as np
from scipy.linalg import block_diag
from scipy.linalg.lapack import dtrtrs

from ...arrays import SquareMatrix
from ...numerics.distributions import chi2_critical
from ..causes.imitation import Imitation, imitations
from ..causes.protocol import Cause, FittedCause, Quantity, Site
from ..causes.registry import CAUSES
from ..dataset.dataset import build_dataset
from ..problem import DiagnosisProblem
from ..regression.gls import Fit
from ..regression.rows import Columns, JointRows
from ..regression.score_test import Score
from ..search.fitter import HypothesisFitter, hypothesis_fitter
from ..search.hypothesis import Candidate, is_determined
from ..thresholds.checks import ALTERNATIVES, SEPARATION
from ..thresholds.regression import COLUMNS
from ..thresholds.search import ENTRY

Answer = Literal["yes", "needs_motion", "never"]


@dataclass(frozen=True, eq=False)
class Smallest:
    """Hold the approximate size from which a cause would be found."""

    quantity: Quantity
    falls: bool
    """Whether the number falls as the effect grows, as the stiffness of an elastic joint does."""


@dataclass(frozen=True, eq=False)
class Shown:
    """Say whether a log can show a cause at a site."""

    cause: Cause
    site: Site
    visible: bool
    """Whether the model's parameters leave enough of it."""
    smallest: Smallest | None
    """None where it is not visible, or has no size."""


@dataclass(frozen=True, eq=False)
class Pair:
    """Say whether a log tells two causes apart."""

    causes: tuple[str, str]
    answer: Answer
    joints: Site
    """Joints on which it does not, from 1."""
    known: Imitation | None
    """What is known of how the two differ."""


@dataclass(frozen=True, eq=False)
class Separability:
    """Hold which causes a log can show, and which of them it distinguishes."""

    shown: tuple[Shown, ...]
    pairs: tuple[Pair, ...]


def separability(problem: DiagnosisProblem) -> Separability:
    """Judge all causes that act all the time.

    Raises
    ------
    ExcitationError
        If no row is left to judge by.
    """
    dataset = build_dataset(problem.model, problem.logs, held_out=problem.held_out, blocks=problem.blocks)
    fitter = hypothesis_fitter(dataset, problem.plan, [each for each in CAUSES if not each.traits.transient])
    plain = fitter.fit(())
    fitter = fitter.linearised_at(plain)
    kinds = _kinds(fitter)
    candidates = list(chain(*kinds))
    scores = dict(zip(candidates, fitter.score(plain, candidates), strict=True))
    clearest = [max(kind, key=lambda candidate: scores[candidate].clear_share) for kind in kinds]
    shown = tuple(_shown(candidate, scores[candidate], plain.fit, len(kinds)) for candidate in clearest)
    shares = _Directions(plain.fit, fitter.rows.fitted, fitter.columns(candidates)).shares
    chosen = [candidates.index(candidate) for candidate in clearest]
    begins = np.cumsum([0, *(len(kind) for kind in kinds[:-1])])
    best = np.maximum.reduceat(shares[chosen], begins, axis=1)
    return Separability(shown, tuple(_pairs(shown, np.maximum(best, best.T))))


def _kinds(fitter: HypothesisFitter) -> list[list[Candidate]]:
    """Give, per cause and site, some candidates evenly spread over the grid of its scalars."""
    grids: dict[tuple[str, Site], list[Candidate]] = {}
    for candidate in fitter.cache.candidates:
        grids.setdefault(candidate.key, []).append(candidate)
    return [
        [
            grid[place]
            for place in np.unique(np.linspace(0, len(grid) - 1, SEPARATION.scalars).round()).astype(int)
        ]
        for grid in grids.values()
    ]


def _shown(candidate: Candidate, score: Score, fit: Fit, kinds: int) -> Shown:
    visible = score.clear_share >= ENTRY.least_clear and is_determined(candidate.cause, score)
    smallest = _smallest(candidate, score, fit, kinds) if visible else None
    return Shown(candidate.cause, candidate.site, visible, smallest)


def _least_explained(site: Site, fit: Fit) -> float:
    """Give what a cause has to explain on one of its joints at least; no joint stands for all."""
    joints = [joint - 1 for joint in site] or range(len(fit.left))
    return ENTRY.least_share * min(float(fit.left[joint] @ fit.left[joint]) for joint in joints)


def _smallest(candidate: Candidate, score: Score, fit: Fit, kinds: int) -> Smallest | None:
    """Give the size at which the likelihood ratio reaches what entry asks for; None where a part is open."""
    level = ENTRY.level / (candidate.trials * kinds)
    statistic = max(chi2_critical(level, score.freedom), _least_explained(candidate.site, fit))
    deviations = np.sqrt(np.maximum(np.diag(score.covariance), 0.0))
    if not deviations.all():
        return None

    def quantities(scale: float) -> tuple[Quantity, ...]:
        size = scale * np.sqrt(statistic) * deviations
        fitted = FittedCause(candidate.site, size, score.covariance, candidate.scalars, {})
        return candidate.cause.quantities(fitted)

    pairs = zip(quantities(1.0), quantities(2.0), strict=True)
    changing = ((own, double) for own, double in pairs if own.value != double.value)
    return next((Smallest(own, abs(double.value) < abs(own.value)) for own, double in changing), None)


class _Directions:
    """Hold what the model leaves of the candidates' columns, as directions."""

    def __init__(self, fit: Fit, joints: Sequence[JointRows], columns: Sequence[Columns]) -> None:
        self._fit, self._joints, self._columns = fit, joints, columns
        self._widths = [next(iter(own.values())).shape[1] for own in columns]

    @cached_property
    def shares(self) -> SquareMatrix:
        """Give, per pair of candidates, the share of the one with fewer directions that the other spans."""
        gram, squares = self._gram
        starts = np.cumsum([0, *self._widths])
        bases = [_basis(gram[begin:end, begin:end], squares[begin:end]) for begin, end in pairwise(starts)]
        basis = block_diag(*bases)
        width = np.array([own.shape[1] for own in bases])
        begins = np.cumsum([0, *width[:-1]])
        cosines = (basis.T @ gram @ basis) ** 2
        sums = np.add.reduceat(np.add.reduceat(cosines, begins, axis=0), begins, axis=1)
        return np.asarray(sums / np.minimum.outer(width, width))

    @property
    def _gram(self) -> tuple[SquareMatrix, np.ndarray]:
        """Give the products of all white columns beside model and nuisance, and their squares before that."""
        places = np.split(np.arange(sum(self._widths)), np.cumsum(self._widths)[:-1])
        size = sum(self._widths)
        gram, squares = np.zeros((size, size)), np.zeros(size)
        cross = np.zeros((len(self._fit.values), size))
        for joint, (rows, own) in enumerate(zip(self._joints, self._fit.joints, strict=True)):
            present = [index for index, columns in enumerate(self._columns) if joint in columns]
            if not present:
                continue
            place = np.concatenate([places[index] for index in present])
            white = own.white(np.hstack([self._columns[index][joint] for index in present])[rows.rows])
            inside = own.nuisance.in_span(white)
            gram[np.ix_(place, place)] += white.T @ white - inside.T @ inside
            squares[place] += np.sum(white**2, axis=0)
            cross[np.ix_(own.acting, place)] += own.columns.T @ white - own.inside.T @ inside
        reduced, _ = dtrtrs(self._fit.factor, cross / self._fit.scale[:, None], lower=1)
        return gram - reduced.T @ reduced, squares


def _basis(gram: SquareMatrix, squares: np.ndarray) -> np.ndarray:
    """Give orthonormal directions of some columns; one of nothing where the model spans them."""
    size = np.sqrt(np.maximum(squares, 1e-300))
    values, vectors = np.linalg.eigh(gram / np.outer(size, size))
    clear = values > COLUMNS.least_clear
    if not clear.any():
        return np.zeros((len(gram), 1))
    return np.asarray((vectors[:, clear] / size[:, None]) / np.sqrt(values[clear]))


def _pairs(shown: Sequence[Shown], shares: SquareMatrix) -> Iterator[Pair]:
    """Judge every pair of different causes by the sites that they share.

    Parameters
    ----------
    shares
        Per pair of kinds, the share of the one's clearest directions that the other can imitate.
    """
    places: dict[str, list[int]] = {}
    for place, kind in enumerate(shown):
        places.setdefault(kind.cause.id, []).append(place)
    for first, second in combinations(places, 2):
        known = imitations(first).get(second) or imitations(second).get(first)
        least = known.share if known else ALTERNATIVES.other_share
        met = list(_shared_sites(shown, places[first], places[second]))
        alike = [site for first_place, other, site in met if 1.0 - shares[first_place, other] < least]
        answer = _answer(known, separated=bool(met) and not alike)
        yield Pair((first, second), answer, tuple(sorted(set(chain(*alike)))), known)


def _answer(known: Imitation | None, *, separated: bool) -> Answer:
    if known and not known.by_motion:
        return "never"
    return "yes" if separated else "needs_motion"


def _shared_sites(
    shown: Sequence[Shown], first: Sequence[int], second: Sequence[int]
) -> Iterator[tuple[int, int, Site]]:
    """Give the visible kinds of two causes that meet, and where: a cause of the whole robot meets all."""
    for first_place, other in product(first, second):
        own, others = shown[first_place], shown[other]
        if own.visible and others.visible and _overlap(own.site, others.site):
            yield first_place, other, own.site or others.site


def _overlap(first: Site, second: Site) -> bool:
    return not first or not second or bool(set(first) & set(second))
