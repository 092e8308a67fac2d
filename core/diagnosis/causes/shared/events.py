"""Find the spans of time in which a residual is a combination of columns: short events in a long log.

Spans of doubling length are tried, half a length apart; the best one is shifted and stretched, and the next
one is searched beside it. The score of a span is the gain of a generalised least squares fit: under
correlated noise the rise and fall of an event carry more information than its size.
Source: Basseville & Nikiforov, Detection of Abrupt Changes (1993), ch. 2 and 7.
"""

from collections.abc import Sequence

import numpy as np
from scipy.sparse import csr_array

from ....arrays import JointSeries, Samples, Vector
from ....dynamics.terms.external_contact import Span, half_sine
from ....numerics.chi2_tail import log_chi2_tail
from ...thresholds.causes import EVENTS

FIRST_STEP, HALVINGS = 0.25, 4
_NOTHING, _RIDGE = 1e-12, 1e-6
ROUNDING = 1e-9
"""Relative lead over an earlier span: many spans with few rows have the same score, and rounding must not
choose."""


def find_events(
    time: Samples, columns: np.ndarray, left: JointSeries, precisions: Sequence[csr_array], *, most: int
) -> list[Span]:
    """Find up to `most` spans that do not overlap, the best one first.

    Parameters
    ----------
    columns
        Samples x columns x joints.
    left
        The residual in the same units.
    precisions
        Per joint, the inverse covariance of its noise; zero on rows that are excluded.
    """
    search = _Search(time, columns, left, precisions)
    spans = search.spans()
    scores = search.scores(spans)
    hurdle = np.log(EVENTS.level / max(len(spans), 1))
    freedom = int(np.count_nonzero(columns.any(axis=(0, 2))))
    found: list[Span] = []
    best = 0.0
    for _ in range(most):
        if not len(spans):
            break
        first = int(np.argmax(scores >= (1.0 - ROUNDING) * scores.max()))
        span = search.refined(spans[first], found)
        score = search.score(span)
        if score < EVENTS.least_share * best or not log_chi2_tail(score, freedom) < hurdle:
            break
        best = max(best, score)
        found.append(span)
        apart = np.array([_apart(trial, [span]) for trial in spans])
        spans, scores = [trial for trial, free in zip(spans, apart, strict=True) if free], scores[apart]
    return found


def _apart(span: Span, others: Sequence[Span]) -> bool:
    return all(span[0] >= other[1] or span[1] <= other[0] for other in others)


class _Search:
    def __init__(
        self, time: Samples, columns: np.ndarray, left: JointSeries, precisions: Sequence[csr_array]
    ) -> None:
        self.time, self.ordered = time, np.maximum.accumulate(time)
        known = np.column_stack([weight @ left[:, joint] for joint, weight in enumerate(precisions)])
        self.gains = np.einsum("raj,rj->ra", columns, known)
        # Information of rows together with those 0, 1, ... rows before them, in both orders.
        rows, count, _ = columns.shape
        self.grams = np.zeros((rows, 1 + _reach(precisions), count, count))
        for lag in range(self.grams.shape[1]):
            self.grams[lag:, lag] = _grams(columns, precisions, lag)

    def spans(self) -> list[Span]:
        first, last = float(self.ordered[0]), float(self.ordered[-1])
        lengths = EVENTS.shortest * 2.0 ** np.arange(round(np.log2(EVENTS.longest / EVENTS.shortest)) + 1)
        return [
            (float(start), float(start + length))
            for length in lengths
            for start in np.arange(first, last - 0.5 * length, 0.5 * length)
        ]

    def score(self, span: Span) -> float:
        """Give the square that the columns explain within a span."""
        return float(self.scores([span])[0])

    def scores(self, spans: Sequence[Span]) -> Vector:
        """Give the same for many spans at once."""
        edges = np.reshape(spans, (-1, 2))
        begins, ends = np.searchsorted(self.ordered, edges.T)
        counts, reach = ends - begins, self.grams.shape[1]
        starts = np.concatenate([[0], np.cumsum(counts)])
        since = np.arange(starts[-1]) - np.repeat(starts[:-1], counts)
        rows = since + np.repeat(begins, counts)
        heights = half_sine(self.time[rows], tuple(np.repeat(edges, counts, axis=0).T))
        # Per row, its height times those of the rows 0, 1, ... before it, as far as these lie in the span.
        pairs = np.zeros((len(rows), reach))
        for lag in range(min(reach, len(rows))):
            pairs[lag:, lag] = heights[lag:] * heights[: len(rows) - lag] * (since[lag:] >= lag)
        columns = (rows[:, None] * reach + np.arange(reach)).ravel()
        both = csr_array((pairs.ravel(), columns, starts * reach), (len(spans), self.grams[..., 0, 0].size))
        size = self.gains.shape[1]
        grams = (both @ self.grams.reshape(-1, size * size)).reshape(-1, size, size)
        gains = csr_array((heights, rows, starts), (len(spans), len(self.gains))) @ self.gains
        traces = np.trace(grams, axis1=1, axis2=2)[:, None]
        scale = np.sqrt(
            np.maximum(np.diagonal(grams, axis1=1, axis2=2), _NOTHING * np.maximum(traces, 1e-30))
        )
        scaled = grams / (scale[:, :, None] * scale[:, None, :]) + _RIDGE * np.eye(size)
        solved = np.linalg.solve(scaled, (gains / scale)[:, :, None])[:, :, 0]
        return np.asarray(np.sum(gains / scale * solved, axis=1))

    def refined(self, span: Span, others: Sequence[Span]) -> Span:
        """Shift both ends by decreasing steps, apart from others, as long as the score rises.

        The peak stays within the log: a peak outside is not observable.
        """
        step, best = FIRST_STEP * (span[1] - span[0]), self.score(span)
        for _ in range(HALVINGS):
            improved = True
            while improved:
                improved = False
                for change in ((-step, 0.0), (step, 0.0), (0.0, -step), (0.0, step)):
                    trial = (span[0] + change[0], span[1] + change[1])
                    lasts = EVENTS.shortest < trial[1] - trial[0] < 2.0 * EVENTS.longest
                    inside = self.ordered[0] <= 0.5 * (trial[0] + trial[1]) <= self.ordered[-1]
                    if not (lasts and inside and _apart(trial, others)):
                        continue
                    score = self.score(trial)
                    if score > (1.0 + ROUNDING) * best:
                        span, best, improved = trial, score, True
            step /= 2.0
        return span


def _reach(precisions: Sequence[csr_array]) -> int:
    """Give the largest distance in rows over which noise is correlated."""
    entries = [weight.tocoo() for weight in precisions]
    return max(int(np.max(entry.row - entry.col, initial=0)) for entry in entries)


def _grams(columns: np.ndarray, precisions: Sequence[csr_array], lag: int) -> np.ndarray:
    weights = np.column_stack([weight.diagonal(-lag) for weight in precisions])
    out = (columns[lag:] * weights[:, None, :]) @ np.swapaxes(columns[: len(columns) - lag], 1, 2)
    return np.asarray(out if lag == 0 else out + np.swapaxes(out, 1, 2))
