"""Refine a candidate's scalars between its grid points by profile likelihood, and give their deviations.

One scalar after the other is searched on top of a hypothesis, at its noise, with the linear parameters
projected out: variable projection. Source: Golub & Pereyra, SIAM J. Numer. Anal. 10(2), 1973.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache

import numpy as np
from scipy.optimize import root_scalar

from ...arrays import Samples, Vector
from ...numerics.chi2_tail import log_chi2_tail
from ..regression.score_test import Score
from ..thresholds.causes import EVENTS
from ..thresholds.search import REFINEMENT
from .fitter import HypothesisFitter
from .hypothesis import Candidate, Hypothesis, admits

RELATIVE_STEP, LEAST_STEP, WIDENINGS = 1e-3, 1e-9, 7
"""Least step over which a curvature is read, relative and absolute, and how often it is doubled at most."""
YIELDINGS = 4
"""Steps of the secant method towards columns that yield the size for which they were computed,"""
SAME_SIZE = 0.01
"""within this share of it."""
FINER = 9
"""Points laid between the neighbours of the best grid point, in each of two rounds."""
AROUND = np.linspace(-1.0, 1.0, 21)
"""Distances from a refined instant to others whose likelihood is computed, s."""


def refine_scalars(
    fitter: HypothesisFitter, under: Hypothesis, candidate: Candidate, *, on_trial: bool = False
) -> Candidate:
    """Refine a candidate's scalars between its grid points, on top of a hypothesis.

    Parameters
    ----------
    on_trial
        Whether their values are enough, without deviations.
    """
    for name in candidate.scalars:
        if name in candidate.cause.traits.self_consistent:
            candidate = _self_consistent(fitter, under, candidate, name)
        elif name not in candidate.cause.traits.discrete:
            candidate, seen = _refine(fitter, under, candidate, name)
            if not on_trial:
                candidate = _with_deviation(fitter, under, candidate, name, seen)
    return candidate


def with_deviations(fitter: HypothesisFitter, under: Hypothesis, candidate: Candidate) -> Candidate:
    """Give the deviations of a candidate's scalars where they are, on top of a hypothesis."""
    for name, here in candidate.scalars.items():
        if name not in (*candidate.cause.traits.self_consistent, *candidate.cause.traits.discrete):
            points, _ = _grid(fitter, candidate, name)
            trials = [_at(candidate, name, value) for value in (*subdivide(*neighbours(points, here)), here)]
            found = fitter.score(under, trials)
            seen = {trial.scalars[name]: score.statistic for trial, score in zip(trials, found, strict=True)}
            candidate = _with_deviation(fitter, under, candidate, name, seen)
    return candidate


def _self_consistent(
    fitter: HypothesisFitter, under: Hypothesis, candidate: Candidate, name: str
) -> Candidate:
    """Linearise the columns at the size that they yield (self-consistent scalar)."""

    @cache
    def off(size: float) -> float:
        (found,) = fitter.score(under, [_at(candidate, name, size)])
        return float(found.values[0]) - size

    here = candidate.scalars[name]
    there = here + off(here)
    if there == here:
        return candidate
    found = root_scalar(off, x0=here, x1=there, method="secant", rtol=SAME_SIZE, maxiter=YIELDINGS)
    return _at(candidate, name, float(found.root))


def _refine(
    fitter: HypothesisFitter, under: Hypothesis, candidate: Candidate, name: str
) -> tuple[Candidate, Mapping[float, float]]:
    """Refine one scalar, and give the statistics of all values that were tried."""
    points, ends = _grid(fitter, candidate, name)
    if name in candidate.cause.traits.onset:
        candidate = _at_likeliest_onset(fitter, under, candidate, name)
    here = candidate.scalars[name]
    # About the nearest grid point: beside one, the way across it would be as short as the distance to it.
    low, high = np.clip(neighbours(points, _nearest(points, here)), *ends)
    if name in candidate.cause.traits.onset and here not in points:
        low, high = here - _row(fitter), here + _row(fitter)
    seen: dict[float, float] = {}
    for _ in range(2):
        values = subdivide(low, high)
        trials = [_at(candidate, name, value) for value in (*values, here)]
        found = fitter.score(under, trials)
        ranks = [(admits(trial, score), score.statistic) for trial, score in zip(trials, found, strict=True)]
        best = ranks.index(max(ranks))
        here = trials[best].scalars[name]
        seen |= {trial.scalars[name]: rank[1] for trial, rank in zip(trials, ranks, strict=True)}
        low, high = neighbours(sorted({*values, here}), here)
    return _at(candidate, name, here), seen


def _at_likeliest_onset(
    fitter: HypothesisFitter, under: Hypothesis, candidate: Candidate, name: str
) -> Candidate:
    """Let a significant candidate begin to act at the row of the largest likelihood.

    The likelihood of an instant has narrow peaks: under noise with a long memory a step shows where it is,
    and hardly later. No grid of a scan is as fine.
    """
    (alone,) = fitter.score(under, [candidate])
    if log_chi2_tail(alone.statistic, alone.freedom) + float(np.log(candidate.trials)) > 0.0:
        return candidate
    time, rows = fitter.dataset.time, np.arange(1, len(fitter.dataset.time))
    throughout, some = _at(candidate, name, -np.inf), candidate.cause.traits.onset[name]
    worth = np.array([score.statistic for score in fitter.score_onsets(under, throughout, some, rows)])
    trials = [candidate, *(_at(candidate, name, instant) for instant in _peaks(time[rows], worth))]
    found = fitter.score(under, trials)
    ranks = [(admits(trial, score), score.statistic) for trial, score in zip(trials, found, strict=True)]
    return trials[ranks.index(max(ranks))]


def _peaks(time: Samples, worth: np.ndarray) -> list[float]:
    """Give the instants of the highest values that keep their distance from each other, the highest first."""
    peaks: list[float] = []
    for instant in time[np.argsort(-worth, kind="stable")]:
        if len(peaks) == REFINEMENT.onsets:
            break
        if all(abs(instant - peak) > EVENTS.shortest for peak in peaks):
            peaks.append(float(instant))
    return peaks


def _row(fitter: HypothesisFitter) -> float:
    """Give the time from row to row, s."""
    return float(np.median(np.diff(fitter.dataset.time)))


def _with_deviation(
    fitter: HypothesisFitter, under: Hypothesis, candidate: Candidate, name: str, seen: Mapping[float, float]
) -> Candidate:
    """Give a refined scalar's deviation, from the likelihood of other values."""
    here = candidate.scalars[name]
    deviation, slope = _deviation_and_slope(fitter, under, candidate, name, neighbours(sorted(seen), here))
    if name in candidate.cause.traits.onset:
        seen = {**seen, **_around_onset(fitter, under, candidate, name)}
    return replace(
        candidate,
        deviations={**candidate.deviations, name: max(deviation, _deviation_of_interval(seen, here))},
        slopes={**candidate.slopes, name: slope},
    )


def _around_onset(
    fitter: HypothesisFitter, under: Hypothesis, candidate: Candidate, name: str
) -> dict[float, float]:
    """Score a refined instant and others before and after it."""
    values = (candidate.scalars[name] + AROUND).tolist()
    found = fitter.score(under, [_at(candidate, name, value) for value in values])
    return {value: score.statistic for value, score in zip(values, found, strict=True)}


def _grid(
    fitter: HypothesisFitter, candidate: Candidate, name: str
) -> tuple[list[float], tuple[float, float]]:
    """Give the points that a scalar was scanned at, and its ends, one step beyond them.

    A scalar that is refined again and again stays within them.
    """
    here = candidate.scalars[name]
    # The operating point may have changed since it was chosen, and the grid with it.
    scanned = [known.scalars.get(name, here) for known in fitter.at.of(candidate.cause, candidate.site)]
    points = sorted({*scanned} or {here})
    return points, (neighbours(points, points[0])[0], neighbours(points, points[-1])[1])


def _deviation_and_slope(
    fitter: HypothesisFitter, under: Hypothesis, candidate: Candidate, name: str, around: tuple[float, float]
) -> tuple[float, Vector]:
    """Read a scalar's deviation off the curvature of the profile likelihood, and the values' slope."""
    here = candidate.scalars[name]
    step = max(0.5 * (around[1] - around[0]), RELATIVE_STEP * abs(here), LEAST_STEP)
    low, middle, high = _scores_beside(fitter, under, candidate, name, step)
    for _ in range(WIDENINGS):
        if _drop(low, middle, high) > REFINEMENT.drop or here - 2.0 * step <= 0.0 < here:
            break
        wider = _scores_beside(fitter, under, candidate, name, 2.0 * step)
        if min(score.clear_share for score in wider) <= 0.0:
            break
        step, (low, middle, high) = 2.0 * step, wider
    slope = (high.values - low.values) / (2.0 * step)
    drop = _drop(low, middle, high)
    if drop <= 0.0:
        return float("inf"), np.zeros_like(slope)
    return float(step / np.sqrt(drop)), slope


def _scores_beside(
    fitter: HypothesisFitter, under: Hypothesis, candidate: Candidate, name: str, step: float
) -> list[Score]:
    here = candidate.scalars[name]
    return fitter.score(under, [_at(candidate, name, here + shift) for shift in (-step, 0.0, step)])


def _at(candidate: Candidate, name: str, value: float) -> Candidate:
    return replace(candidate, scalars={**candidate.scalars, name: value})


def _deviation_of_interval(seen: Mapping[float, float], here: float) -> float:
    """Give the deviation that corresponds to the farthest value inside the 95 % likelihood interval.

    The likelihood of an instant has edges, and no curvature to read a deviation from.
    """
    best = max(seen.values())
    likely = [
        abs(value - here) for value, statistic in seen.items() if best - statistic < REFINEMENT.interval**2
    ]
    return max(likely) / REFINEMENT.interval


def _drop(low: Score, middle: Score, high: Score) -> float:
    return middle.statistic - 0.5 * (low.statistic + high.statistic)


def neighbours(points: Sequence[float], here: float) -> tuple[float, float]:
    """Give the points on either side; beyond an end, as far as the other neighbour."""
    points = sorted({*points, here})
    index = points.index(here)
    if len(points) == 1:
        return 0.5 * here, 2.0 * here
    low = points[index - 1] if index else _mirror(here, points[index + 1])
    high = points[index + 1] if index + 1 < len(points) else _mirror(here, points[index - 1])
    return low, high


def _nearest(points: Sequence[float], here: float) -> float:
    """Give the nearest of some points: by ratio where all are positive, as they are subdivided."""
    ratios = min(*points, here) > 0.0
    return min(points, key=lambda point: abs(np.log(point / here)) if ratios else abs(point - here))


def _mirror(here: float, other: float) -> float:
    if here > 0.0 and other > 0.0:
        return here * here / other
    return 2.0 * here - other


def subdivide(low: float, high: float) -> list[float]:
    """Give points between two: in equal ratios where both are positive."""
    if low > 0.0:
        return [float(point) for point in np.geomspace(low, high, FINER + 2)[1:-1]]
    return [float(point) for point in np.linspace(low, high, FINER + 2)[1:-1]]
