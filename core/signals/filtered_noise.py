"""Say how much noise of positions the filters leave in accelerations.

An encoder's noise is white. What the filter on positions, two differences and the parallel filter pass of it
follows from their gains; keeping one sample in several does not change its variance. Noise of low frequency
cannot be told from motion and is not counted.
"""

from collections.abc import Sequence

import numpy as np

from ..arrays import JointVector
from .condition import Motion
from .derivative import differentiator_gain
from .zero_phase import gain

_FREQUENCIES = 1001
_LOWEST = 1e-3
"""Share of the cut-off below which nothing of an acceleration's noise lies."""


def acceleration_variance(motions: Sequence[Motion]) -> JointVector:
    """Give the variance of the noise of filtered accelerations over all motions together, (rad/s2)2.

    A joint that stands all the time has no acceleration, and no noise of one.
    """
    instants = np.array([motion.kept for motion in motions])
    recipes = [motion.recipe for motion in motions]
    noise = np.array([np.where(recipe.held, 0.0, recipe.position_noise) for recipe in recipes])
    passed = np.array([_passed(motion) for motion in motions])
    return np.asarray((instants / instants.sum() * passed) @ noise**2)


def _passed(motion: Motion) -> float:
    """Give the variance that white noise of unit variance has after all filters."""
    rate, recipe = motion.log.rate_hz, motion.recipe
    frequency = np.geomspace(_LOWEST * recipe.cutoff_hz, 0.5 * rate, _FREQUENCIES)
    power = differentiator_gain(frequency, rate) ** 4
    for cutoff in (recipe.cutoff_hz, recipe.position_cutoff_hz):
        power *= gain(frequency, cutoff_hz=cutoff, rate_hz=rate, order=recipe.order) ** 2
    return float(np.trapezoid(power, frequency) / (0.5 * rate))
