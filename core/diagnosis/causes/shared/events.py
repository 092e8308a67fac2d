"""Find the spans of time in which a residual follows some columns: short events in a long log.

All spans of doubling length are tried, half a length apart, then the best is shifted and stretched; the next
one is looked for beside it. A span is worth what a fit under the noise's memory would gain: against noise
that remembers, how an event swells and fades tells more than how large it is.
Source: Basseville & Nikiforov, Detection of Abrupt Changes (1993), ch. 2 and 7.
"""

from collections.abc import Sequence

import numpy as np
from scipy.sparse import csr_array

from ....arrays import JointSeries, Samples, Vector
from ....dynamics.terms.contact import Span, swell
from ....numerics.chi2_tail import log_chi2_tail

SHORTEST, LONGEST = 0.2, 3.2
"""Lengths in s: shorter events are outliers, longer ones last."""
LUCK = 1e-3
"""Chance that noise alone is worth as much somewhere in a log as an event has to be,"""
TRIALS_OF_A_SPAN = 2.0
"""where shifting and stretching the best span doubles what was tried."""
LEAST_SHARE = 0.2
"""An event is worth at least this share of the best one."""
HALVINGS = 4
ROUNDING = 1e-9
"""Share by which a span has to be worth more than one before it: where few rows tell, many are worth the
same, and rounding must not choose."""


def find_events(
    time: Samples,
    columns: np.ndarray,
    left: JointSeries,
    inverse_covariances: Sequence[csr_array],
    *,
    most: int,
) -> list[Span]:
    """Find up to `most` spans that do not overlap, the best one first.

    Parameters
    ----------
    columns
        Samples x columns x joints.
    left
        The residual in the same units.
    inverse_covariances
        Per joint, the inverse covariance of its noise; zero where nothing may be looked at.
    """
    search = _Search(time, columns, left, inverse_covariances)
    spans = search.spans()
    worths = search.worths(spans)
    hurdle = np.log(LUCK / max(TRIALS_OF_A_SPAN * len(spans), 1.0))
    freedom = int(np.count_nonzero(columns.any(axis=(0, 2))))
    found: list[Span] = []
    best = 0.0
    for _ in range(most):
        if not len(spans):
            break
        first = int(np.argmax(worths >= (1.0 - ROUNDING) * worths.max()))
        span = search.refined(spans[first], found)
        worth = search.worth(span)
        if worth < LEAST_SHARE * best or not log_chi2_tail(worth, freedom) < hurdle:
            break
        best = max(best, worth)
        found.append(span)
        apart = np.array([_apart(one, [span]) for one in spans])
        spans, worths = [one for one, free in zip(spans, apart, strict=True) if free], worths[apart]
    return found


def _apart(span: Span, others: Sequence[Span]) -> bool:
    return all(span[0] >= one[1] or span[1] <= one[0] for one in others)


class _Search:
    def __init__(
        self, time: Samples, columns: np.ndarray, left: JointSeries, inverse_covariances: Sequence[csr_array]
    ) -> None:
        self.time, self.ordered = time, np.maximum.accumulate(time)
        known = np.column_stack([one @ left[:, joint] for joint, one in enumerate(inverse_covariances)])
        self.gains = np.einsum("raj,rj->ra", columns, known)
        # What rows tell together with those 0, 1, ... rows before them, both ways at once.
        rows, count, _ = columns.shape
        self.grams = np.zeros((rows, 1 + _reach(inverse_covariances), count, count))
        for lag in range(self.grams.shape[1]):
            self.grams[lag:, lag] = _grams(columns, inverse_covariances, lag)

    def spans(self) -> list[Span]:
        first, last = float(self.ordered[0]), float(self.ordered[-1])
        lengths = SHORTEST * 2.0 ** np.arange(round(np.log2(LONGEST / SHORTEST)) + 1)
        return [
            (float(start), float(start + length))
            for length in lengths
            for start in np.arange(first, last - 0.5 * length, 0.5 * length)
        ]

    def worth(self, span: Span) -> float:
        """Give the square that the columns explain within a span."""
        return float(self.worths([span])[0])

    def worths(self, spans: Sequence[Span]) -> Vector:
        """Give the same for many spans at once."""
        edges = np.reshape(spans, (-1, 2))
        begins, ends = np.searchsorted(self.ordered, edges.T)
        counts, reach = ends - begins, self.grams.shape[1]
        starts = np.concatenate([[0], np.cumsum(counts)])
        since = np.arange(starts[-1]) - np.repeat(starts[:-1], counts)
        rows = since + np.repeat(begins, counts)
        heights = swell(self.time[rows], tuple(np.repeat(edges, counts, axis=0).T))
        # Per row, its height times those of the rows 0, 1, ... before it, as far as these lie in the span.
        pairs = np.zeros((len(rows), reach))
        for lag in range(min(reach, len(rows))):
            pairs[lag:, lag] = heights[lag:] * heights[: len(rows) - lag] * (since[lag:] >= lag)
        places = (rows[:, None] * reach + np.arange(reach)).ravel()
        both = csr_array((pairs.ravel(), places, starts * reach), (len(spans), self.grams[..., 0, 0].size))
        size = self.gains.shape[1]
        grams = (both @ self.grams.reshape(-1, size * size)).reshape(-1, size, size)
        gains = csr_array((heights, rows, starts), (len(spans), len(self.gains))) @ self.gains
        traces = np.trace(grams, axis1=1, axis2=2)[:, None]
        scale = np.sqrt(np.maximum(np.diagonal(grams, axis1=1, axis2=2), 1e-12 * np.maximum(traces, 1e-30)))
        scaled = grams / (scale[:, :, None] * scale[:, None, :]) + 1e-6 * np.eye(size)
        solved = np.linalg.solve(scaled, (gains / scale)[:, :, None])[:, :, 0]
        return np.asarray(np.sum(gains / scale * solved, axis=1))

    def refined(self, span: Span, others: Sequence[Span]) -> Span:
        """Shift both ends by smaller and smaller steps, apart from others, as long as that explains more.

        The peak stays within the log: nothing tells how high one was that nobody saw.
        """
        step, best = 0.25 * (span[1] - span[0]), self.worth(span)
        for _ in range(HALVINGS):
            improved = True
            while improved:
                improved = False
                for change in ((-step, 0.0), (step, 0.0), (0.0, -step), (0.0, step)):
                    trial = (span[0] + change[0], span[1] + change[1])
                    lasts = SHORTEST < trial[1] - trial[0] < 2.0 * LONGEST
                    seen = self.ordered[0] <= 0.5 * (trial[0] + trial[1]) <= self.ordered[-1]
                    if not (lasts and seen and _apart(trial, others)):
                        continue
                    worth = self.worth(trial)
                    if worth > (1.0 + ROUNDING) * best:
                        span, best, improved = trial, worth, True
            step /= 2.0
        return span


def _reach(inverse_covariances: Sequence[csr_array]) -> int:
    """Say how many rows apart the noise still ties two of them together."""
    ties = [one.tocoo() for one in inverse_covariances]
    return max(int(np.max(one.row - one.col, initial=0)) for one in ties)


def _grams(columns: np.ndarray, inverse_covariances: Sequence[csr_array], lag: int) -> np.ndarray:
    weights = np.column_stack([one.diagonal(-lag) for one in inverse_covariances])
    out = (columns[lag:] * weights[:, None, :]) @ np.swapaxes(columns[: len(columns) - lag], 1, 2)
    return np.asarray(out if lag == 0 else out + np.swapaxes(out, 1, 2))
