"""Differentiate and remove absurd samples: the two local operations of the seed's chain.

Both work on a stretch that carries its neighbours on either side and give back the inner part, so that a long
log can be processed stretch after stretch without seams. Source: the seed paper, section 4.1; Fornberg,
Mathematics of Computation 51 (1988), for the weights of the differentiator.
"""

import numpy as np

from ..arrays import InstantSeries, JointSeries, Vector
from ..numerics.filtering import running_maximum

REACH = 3
"""Samples on either side that a derivative is computed from."""


def differentiate(values: JointSeries, rate_hz: float) -> InstantSeries:
    """Differentiate along time by the maximally flat difference of seven samples; three at each end go.

    It belongs to the middle instant exactly, and is exact for polynomials up to order six. A sine of w rad
    per sample comes out too small by w^6 / 140: at a twentieth of the rate by 7e-6, where the difference of
    two neighbours gives 1.6e-2.

    Examples
    --------
    >>> differentiate(np.arange(8.0)[:, None] ** 2, 1.0).ravel()
    array([6., 8.])
    """
    count = len(values) - 2 * REACH
    one, two, three = (
        values[REACH + steps :][:count] - values[REACH - steps :][:count] for steps in range(1, REACH + 1)
    )
    return np.asarray((45.0 * one - 9.0 * two + three) * (rate_hz / 60.0))


def differentiator_gain(frequency_hz: Vector, rate_hz: float) -> Vector:
    """Give the gain of the difference at some frequencies, per s.

    Examples
    --------
    >>> (differentiator_gain(np.array([0.0, 1.0]), 100.0) / (2.0 * np.pi)).round(6)
    array([0., 1.])
    """
    one, two, three = (np.sin(2.0 * np.pi * steps * frequency_hz / rate_hz) for steps in range(1, REACH + 1))
    return np.asarray((45.0 * one - 9.0 * two + three) * (rate_hz / 30.0))


def differentiate_throughout(values: JointSeries, rate_hz: float) -> InstantSeries:
    """Differentiate at every sample; within three of an end only a straight line comes out exactly."""
    return differentiate(continued(values, REACH), rate_hz)


def continued(values: JointSeries, samples: int) -> InstantSeries:
    """Continue a series beyond both ends by turning it about its end points."""
    if len(values) <= samples:  # it has to be turned several times
        return np.pad(values, ((samples, samples), (0, 0)), mode="reflect", reflect_type="odd")
    before = 2.0 * values[:1] - values[samples:0:-1]
    after = 2.0 * values[-1:] - values[-2 : -2 - samples : -1]
    return np.concatenate([before, values, after])


BEYOND_BENDS = 2.0
"""A sample is absurd that lies further from its running median than so many times the sharpest bend of the
medians about it, times the samples that these see on either side. A parabola's vertex lies a quarter of one
away; white noise does so seven times in a thousand samples."""
BENDS = 3
"""The bends of so many reaches of the median on either side are looked at."""


def without_absurd(values: JointSeries, order: int) -> InstantSeries:
    """Replace absurd samples by their running median of odd order; `absurd_reach` samples at either end go.

    All others stay as they are: a running median flattens every turning point.

    Examples
    --------
    >>> curve = np.arange(-10.0, 11.0)[:, None] ** 2
    >>> without_absurd(curve, 5).ravel()
    array([1., 0., 1.])
    >>> curve[11] = 100.0
    >>> without_absurd(curve, 5).ravel()
    array([1., 0., 4.])
    """
    if order == 1:
        return values
    side = order // 2
    medians = median(values, order)
    bends = np.abs(medians[2:] - 2.0 * medians[1:-1] + medians[:-2])
    wide, reach = BENDS * side, absurd_reach(order)
    sharpest = running_maximum(bends, wide)[wide : len(bends) - wide]
    inner, usual = values[reach : len(values) - reach], medians[wide + 1 : len(medians) - wide - 1]
    return np.asarray(np.where(np.abs(inner - usual) > BEYOND_BENDS * side * sharpest, usual, inner))


def absurd_reach(order: int) -> int:
    """Count the samples on either side by which one is judged."""
    return 0 if order == 1 else (BENDS + 1) * (order // 2) + 1


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
