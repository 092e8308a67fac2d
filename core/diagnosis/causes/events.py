"""Find the spans of time in which a residual follows some columns: short events in a long log.

All spans of doubling length are tried, half a length apart, then the best is shifted and stretched; the next
one is looked for beside it. Source: Basseville & Nikiforov, Detection of Abrupt Changes (1993), ch. 2.
"""

import numpy as np

from core.arrays import JointSeries, Samples
from core.dynamics.terms.contact import Span, swell

SHORTEST, LONGEST = 0.2, 3.2
"""Lengths in s: shorter events are outliers, longer ones last."""
LEAST_WORTH = 60.0
"""Below it, in squares of the residual's RMS, the best span of many is luck."""
LEAST_SHARE = 0.2
"""An event is worth at least this share of the best one."""
HALVINGS = 4


def find_events(time: Samples, columns: np.ndarray, left: JointSeries, *, most: int) -> list[Span]:
    """Find up to `most` spans that do not overlap, the best one first.

    Parameters
    ----------
    columns
        Samples x columns x joints, in units of the residual's RMS; zero where nothing may be looked at.
    left
        The residual in the same units.
    """
    search = _Search(time, columns, left)
    spans = search.spans()
    worths = np.array([search.worth(span) for span in spans])
    found: list[Span] = []
    best = 0.0
    for _ in range(most):
        if not len(spans):
            break
        index = int(np.argmax(worths))
        if worths[index] < max(LEAST_WORTH, LEAST_SHARE * best):
            break
        span = search.refined(spans[index])
        best = max(best, search.worth(span))
        found.append(span)
        apart = np.array([one[0] >= span[1] or one[1] <= span[0] for one in spans])
        spans, worths = [one for one, free in zip(spans, apart, strict=True) if free], worths[apart]
    return found


class _Search:
    def __init__(self, time: Samples, columns: np.ndarray, left: JointSeries) -> None:
        self.order = np.argsort(time, kind="stable")
        self.time = time[self.order]
        columns, left = columns[self.order], left[self.order]
        self.gains = np.einsum("raj,rj->ra", columns, left)
        self.grams = np.einsum("raj,rbj->rab", columns, columns)

    def spans(self) -> list[Span]:
        first, last = float(self.time[0]), float(self.time[-1])
        lengths = SHORTEST * 2.0 ** np.arange(round(np.log2(LONGEST / SHORTEST)) + 1)
        return [
            (float(start), float(start + length))
            for length in lengths
            for start in np.arange(first, last - 0.5 * length, 0.5 * length)
        ]

    def worth(self, span: Span) -> float:
        """Give the square that the columns explain within a span."""
        rows = slice(*np.searchsorted(self.time, span))
        height = swell(self.time[rows], span)
        gram = np.tensordot(height**2, self.grams[rows], axes=1)
        gain = height @ self.gains[rows]
        scale = np.sqrt(np.maximum(np.diag(gram), 1e-12 * max(float(np.trace(gram)), 1e-30)))
        scaled = gram / np.outer(scale, scale) + 1e-6 * np.eye(len(gain))
        return float((gain / scale) @ np.linalg.solve(scaled, gain / scale))

    def refined(self, span: Span) -> Span:
        """Shift both ends by smaller and smaller steps as long as that explains more."""
        step, best = 0.25 * (span[1] - span[0]), self.worth(span)
        for _ in range(HALVINGS):
            improved = True
            while improved:
                improved = False
                for change in ((-step, 0.0), (step, 0.0), (0.0, -step), (0.0, step)):
                    trial = (span[0] + change[0], span[1] + change[1])
                    if SHORTEST < trial[1] - trial[0] < 2.0 * LONGEST and self.worth(trial) > best:
                        span, best, improved = trial, self.worth(trial), True
            step /= 2.0
        return span
