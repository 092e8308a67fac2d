"""Tell a column that does nothing on a robot from one that is small: what is left of rounding becomes zero.

A planar arm does not feel a force across its plane; computed, that column is rounding, and a fit would scale
it up to a parameter of any size.
"""

from collections.abc import Sequence

import numpy as np

from ...arrays import JointSeries

ROUNDING = 1e-9
"""Share of the largest of some columns below which another one is rounding."""


def without_rounding(torques: Sequence[JointSeries]) -> list[JointSeries]:
    """Give the columns with those set to zero that only rounding keeps from it."""
    sizes = [float(np.abs(one).max(initial=0.0)) for one in torques]
    least = ROUNDING * max(sizes)
    return [one if size > least else np.zeros_like(one) for one, size in zip(torques, sizes, strict=True)]
