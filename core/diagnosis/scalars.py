"""Settle a candidate's scalars between its grid points, and tell how well they are known.

One scalar after the other is searched on top of a hypothesis, at its noise, all linear parameters following:
variable projection. Source: Golub & Pereyra, SIAM J. Numer. Anal. 10(2), 1973.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.optimize import minimize_scalar

from core.arrays import Vector
from core.diagnosis.bench import Bench
from core.diagnosis.grid import between, neighbours
from core.diagnosis.hypothesis import Candidate, Hypothesis, allowed, likeliness
from core.diagnosis.score import Score

YIELDINGS = 10
"""Sizes that columns are built for at most, before one yields itself"""
SAME_SIZE = 0.01
"""within this share."""
NEARLY = 1.96
"""Deviations of a scalar within which 95 % of its values lie."""


def refined(bench: Bench, under: Hypothesis, candidate: Candidate) -> Candidate:
    """Settle a candidate's scalars between its grid points, on top of a hypothesis."""
    for name in candidate.scalars:
        if name in candidate.cause.yielded:
            candidate = _yielding(bench, under, candidate, name)
        elif name not in candidate.cause.settled:
            candidate = _refined(bench, under, candidate, name)
    return candidate


def _yielding(bench: Bench, under: Hypothesis, candidate: Candidate, name: str) -> Candidate:
    """Build the columns for the size at which they are likeliest to yield it."""

    def unlikely(size: float) -> float:
        trial = _at(candidate, name, size)
        (found,) = bench.scored(under, [trial])
        return -likeliness(trial, found)

    here, ends = candidate.scalars[name], _bracket(bench, candidate, name)
    within = SAME_SIZE * abs(here)
    found = minimize_scalar(
        unlikely, bounds=ends, method="bounded", options={"maxiter": YIELDINGS, "xatol": within}
    )
    return _at(candidate, name, float(found.x))


def _refined(bench: Bench, under: Hypothesis, candidate: Candidate, name: str) -> Candidate:
    here = candidate.scalars[name]
    low, high = _bracket(bench, candidate, name)
    seen: list[tuple[float, float]] = []
    for _ in range(2):
        values = between(low, high)
        trials = [_at(candidate, name, value) for value in (*values, here)]
        found = bench.scored(under, trials)
        ranks = [(allowed(trial, one), one.statistic) for trial, one in zip(trials, found, strict=True)]
        best = ranks.index(max(ranks))
        here = trials[best].scalars[name]
        seen += [(trial.scalars[name], rank[1]) for trial, rank in zip(trials, ranks, strict=True)]
        order = sorted({*values, here})
        low, high = neighbours(order, here)
    settled = _at(candidate, name, here)
    deviation, slope = _spread(bench, under, settled, name, (low, high))
    return replace(
        settled,
        deviations={**candidate.deviations, name: max(deviation, _reach(seen, here))},
        slopes={**candidate.slopes, name: slope},
    )


def _bracket(bench: Bench, candidate: Candidate, name: str) -> tuple[float, float]:
    """Give the grid's points on either side of a scalar.

    What is settled again and again may not wander off: it ends one step beyond the grid.
    """
    here = candidate.scalars[name]
    # What is believed may have changed since it was chosen, and the grid with it.
    points = sorted({one.scalars.get(name, here) for one in _grid(bench, candidate)})
    ends = neighbours(points, points[0])[0], neighbours(points, points[-1])[1]
    low, high = np.clip(neighbours(points, here), *ends)
    return float(low), float(high)


def _spread(
    bench: Bench, under: Hypothesis, candidate: Candidate, name: str, around: tuple[float, float]
) -> tuple[float, Vector]:
    """Read a scalar's deviation off the curvature of the profile likelihood, and the values' slope."""
    here = candidate.scalars[name]
    step = max(0.5 * (around[1] - around[0]), 1e-3 * abs(here), 1e-9)
    low, middle, high = _beside(bench, under, candidate, name, step)
    for _ in range(7):
        if _drop(low, middle, high) > 0.5 or here - 2.0 * step <= 0.0 < here:
            break
        wider = _beside(bench, under, candidate, name, 2.0 * step)
        if min(one.clear_share for one in wider) <= 0.0:
            break
        step, (low, middle, high) = 2.0 * step, wider
    slope = (high.values - low.values) / (2.0 * step)
    drop = _drop(low, middle, high)
    if drop <= 0.0:
        return float("inf"), np.zeros_like(slope)
    return float(step / np.sqrt(drop)), slope


def _beside(bench: Bench, under: Hypothesis, candidate: Candidate, name: str, step: float) -> list[Score]:
    here = candidate.scalars[name]
    return bench.scored(under, [_at(candidate, name, here + shift) for shift in (-step, 0.0, step)])


def _at(candidate: Candidate, name: str, value: float) -> Candidate:
    return replace(candidate, scalars={**candidate.scalars, name: value})


def _grid(bench: Bench, candidate: Candidate) -> list[Candidate]:
    same = (candidate.cause, candidate.site)
    return [one for one in bench.candidates if (one.cause, one.site) == same] or [candidate]


def _reach(seen: Sequence[tuple[float, float]], here: float) -> float:
    """Give the deviation that the farthest of the values which are nearly as likely stands for.

    The likelihood of an instant has edges, and no curvature that tells how well it is known.
    """
    best = max(statistic for _, statistic in seen)
    likely = [abs(value - here) for value, statistic in seen if best - statistic < NEARLY**2]
    return max(likely) / NEARLY


def _drop(low: Score, middle: Score, high: Score) -> float:
    return middle.statistic - 0.5 * (low.statistic + high.statistic)
