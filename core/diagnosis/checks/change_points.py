"""Find change points: instants at which a torque switches by itself between two levels.

The residual is smoothed with several widths, and changes side where it exceeds a level on the other one. Each
set of change points is scored like any pattern, with every instant counted as one of all that the bandwidth
resolves. Source: Yao, Statistics & Probability Letters 6(3), 1988, on the penalty of a change point.
"""

from collections.abc import Iterator
from itertools import product

import numpy as np
from scipy.ndimage import uniform_filter1d

from ...arrays import Indices, JointSeries, Samples, Vector
from ...numerics.chi2_tail import log_chi2_tail
from ..search.fitter import HypothesisFitter
from ..search.hypothesis import Candidate, Hypothesis
from ..thresholds.dataset import BAND
from ..thresholds.residual import PREDICTION
from .unnamed_pattern import UnnamedPatternCause

SMOOTHED = (3, 5, 9, 15)
"""Rows that are averaged."""
FAR = (0.0, 0.3, 0.6, 0.9, 1.2)
"""Levels that count as exceeded, in RMS of the smoothed residual."""
_UNLISTED = UnnamedPatternCause()


def switching_candidates(
    fitter: HypothesisFitter, now: Hypothesis, residual: JointSeries
) -> tuple[Candidate, ...]:
    """Give, per joint, the likeliest change points of its residual (rows x joints).

    None where there are several logs: their instants are the same, and what happened at them is not.
    """
    dataset, found = fitter.dataset, []
    for joint, (series, usable) in enumerate(zip(residual.T, dataset.usable.T, strict=True), start=1):
        rows = int(np.count_nonzero(usable))
        if rows < PREDICTION.least_rows or dataset.log.any():
            continue
        ways = list(_change_sets(dataset.time, joint, np.where(usable, series, 0.0), rows))
        chances = [
            log_chi2_tail(scored.statistic, scored.freedom) + np.log(way.trials)
            for scored, way in zip(fitter.score(now, ways), ways, strict=True)
        ]
        if ways:
            found.append(ways[int(np.argmin(chances))])
    return tuple(found)


def _change_sets(time: Samples, joint: int, series: Samples, rows: int) -> Iterator[Candidate]:
    """Give a joint's sets of change points that are neither too few nor too many to be tested."""
    for changes in _changes(series):
        trials = _log_trials(len(changes), rows / BAND.rows)
        if len(changes) > 1 and trials < np.log(np.finfo(float).max):
            instants = 0.5 * (time[changes] + time[changes + 1])
            yield Candidate(_UNLISTED, (joint,), _UNLISTED.switching(instants), float(np.exp(trials)))


def _changes(series: Vector) -> Iterator[Indices]:
    """List the rows after which a series changes side, for all widths and levels."""
    for width, far in product(SMOOTHED, FAR):
        side = sides(uniform_filter1d(series, width), far)
        yield np.flatnonzero(side[1:] != side[:-1])


def sides(series: Vector, far: float) -> Vector:
    """Give the side of a series: the one on which it last exceeded a level, in RMS.

    Examples
    --------
    >>> sides(np.array([0.1, 2.0, -0.1, 0.1, -2.0]), 0.5)
    array([ 1.,  1.,  1.,  1., -1.])
    """
    over = np.abs(series) > far * np.sqrt(np.mean(series**2))
    last = np.maximum.accumulate(np.where(over, np.arange(len(series)), np.argmax(over)))
    return np.asarray(np.sign(series[last]))


def _log_trials(changes: int, instants: float) -> float:
    """Give the logarithm of the number of ways to choose so many of the instants."""
    return float(changes * (1.0 + np.log(max(instants / changes, 1.0)))) if changes else 0.0
