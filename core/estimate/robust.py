"""Weigh down the rows that no model of this kind explains: Huber's weights from the fit before.

A row whose residual exceeds 1.345 joint noises counts in proportion to the excess, so that spikes and
collisions pull no parameter. Residuals are recomputed tile by tile; nothing is stored. Source: Huber 1981;
Holland & Welsch 1977.
"""

import numpy as np

from ..arrays import BaseParameters, Indices, JointVector, Samples, Weights
from ..regressor.observe import Rows, Weigh

HUBER = 1.345
ROUNDS = 3


def huber_weights(base: BaseParameters, columns_of: tuple[Indices, ...], noise: JointVector) -> Weigh:
    """Give the row weights (to be applied to rows, so the roots of Huber's) that these parameters suggest."""

    def weigh(pairs: list[Rows]) -> list[Weights]:
        return [
            _root_weight(rows[:, -1] - rows[:, :-1] @ base[columns], sigma)
            for (rows, _), columns, sigma in zip(pairs, columns_of, noise, strict=True)
        ]

    return weigh


def _root_weight(residual: Samples, noise: float) -> Samples:
    size = np.maximum(np.abs(residual), 1e-300)
    return np.asarray(np.sqrt(np.minimum(1.0, HUBER * noise / size)))
