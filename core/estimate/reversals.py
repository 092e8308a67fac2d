"""Weigh the rows beside a joint's reversals by their own noise, estimated from the log like the joints'.

While a joint sticks, its friction is whatever holds it, between minus and plus Coulomb's level, and rows that
the sign of a filtered velocity describes hold an error of up to that level. Where joints stick this is the
largest error of a fit; where they do not, or other errors are larger, such a row is worth as much as any. So
the rows of a joint form two groups, each divided by its own residual: feasible generalised least squares. A
weight keeps a true equation true. Source: Harvey, Econometrica 44, 1976, for groupwise variances; Gautier
1997 for the joints'.
"""

import numpy as np

from ..arrays import Indices, JointVector
from ..regressor.factor import Factor
from .system import joint_noise, stacked, weighted

ROUNDS = 5
"""Every round leaves less of the sticking in the fit that tells it. On simulated arms, three settle it."""
ROWS_PER_PARAMETER = 2
"""Equations of moving joints per base parameter at least; a fit to fewer follows their noise and hides it."""


def reversal_weights(
    moving: tuple[Factor, ...], turning: tuple[Factor, ...], columns_of: tuple[Indices, ...], base: int
) -> JointVector:
    """Give the weight of every joint's rows beside its reversals: noise of the other rows over theirs.

    One where they are no noisier, and where most of a joint's rows lie beside reversals, so that the others
    do not tell.

    Parameters
    ----------
    moving, turning
        Per joint, the factors of the two groups of rows.
    base
        Number of base parameters.
    """
    ones = np.ones(len(moving))
    known = np.array([first.rows >= second.rows > 0 for first, second in zip(moving, turning, strict=True)])
    if not known.any() or sum(factor.rows for factor in moving) <= ROWS_PER_PARAMETER * base:
        return ones
    weights, values = ones, weighted(_joined(moving, turning, ones), columns_of, base).solved()
    for _ in range(ROUNDS):
        quiet, loud = (joint_noise(factors, columns_of, values) for factors in (moving, turning))
        weights = np.where(known, np.minimum(1.0, quiet / np.maximum(loud, quiet)), 1.0)
        values = stacked(_joined(moving, turning, weights), columns_of, base, quiet).solved()
    return weights


def _joined(
    moving: tuple[Factor, ...], turning: tuple[Factor, ...], weights: JointVector
) -> tuple[Factor, ...]:
    parts = zip(moving, turning, weights, strict=True)
    return tuple(first.merged(second.scaled(float(weight))) for first, second, weight in parts)
