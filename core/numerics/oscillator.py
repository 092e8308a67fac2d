"""Integrate a damped oscillator whose coefficients change along a series.

Over a step its coefficients are taken as constant, and its free motion is exact. The weights of the three
pulls about a sample are those that are exact for pulls up to second order in time.
"""

import numpy as np

from ..arrays import Samples
from .following import swing_freely

MOST_DAMPED = 0.999
"""Share of critical damping from which on more is taken for this: the free motion then no longer swings."""


def swing(pulls: Samples, step: float, squares: Samples, decays: Samples) -> Samples:
    """Solve x'' + 2 decay x' + square x = pull, which rests under its first pull at the first sample.

    Parameters
    ----------
    pulls
        Right side, per s2 (so below, each per sample).
    step
        Time between samples, s.
    squares, decays
        Squared angular frequency, 1/s2, which is positive, and decay, 1/s.

    Examples
    --------
    Under a pull that grows steadily it follows, late by twice the decay over the square.

    >>> ones = np.ones(400)
    >>> float(np.round(swing(np.arange(400.0), 1.0, ones, 0.25 * ones)[-1], 6))
    398.5
    """
    most = MOST_DAMPED * np.sqrt(squares)
    decays = np.clip(decays, -most, most)
    kept, cosine = np.exp(-decays * step), np.cos(np.sqrt(squares - decays**2) * step)
    followed = np.empty(len(pulls))
    swing_freely(pulls, step, (squares, decays, kept, cosine), followed)
    return followed
