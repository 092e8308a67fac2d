"""Differentiate and remove absurd samples: the two local operations of the seed's chain.

Both work on a stretch that carries its neighbours on either side and give back the inner part, so that a long
log can be processed stretch after stretch without seams. Source: the seed paper, section 4.1.
"""

import numpy as np

from ..arrays import InstantSeries, JointSeries


def centred_difference(values: JointSeries, rate_hz: float) -> InstantSeries:
    """Differentiate along time; the first and last sample are consumed.

    (x[k+1] - x[k-1]) rate / 2 belongs to instant k exactly, and is exact for a quadratic.

    Examples
    --------
    >>> centred_difference(np.array([[0.0], [1.0], [4.0], [9.0]]), 1.0).ravel()
    array([2., 4.])
    """
    return np.asarray((values[2:] - values[:-2]) * (0.5 * rate_hz))


def median(values: JointSeries, order: int) -> InstantSeries:
    """Take the running median of odd order; (order - 1) / 2 samples are consumed on either side.

    Examples
    --------
    >>> median(np.array([[0.0], [0.0], [9.0], [0.0], [0.0]]), 5).ravel()
    array([0.])
    """
    if order == 1:
        return values
    if order == 5:
        return _median_of_five(values)
    return np.asarray(np.median(np.lib.stride_tricks.sliding_window_view(values, order, axis=0), axis=-1))


def _median_of_five(values: JointSeries) -> InstantSeries:
    a, b, c, d, e = (values[shift : len(values) - 4 + shift] for shift in range(5))
    low, high = np.minimum(a, b), np.maximum(a, b)
    other_low, other_high = np.minimum(c, d), np.maximum(c, d)
    lower, upper = np.maximum(low, other_low), np.minimum(high, other_high)
    return np.asarray(np.maximum(np.minimum(lower, upper), np.minimum(np.maximum(lower, upper), e)))
