"""Condense weighted equations to as many as there are columns."""

from collections.abc import Sequence

import numpy as np
from scipy.linalg import cholesky, solve_triangular

from ..arrays import Indices, JointVector, Series, Vector
from ..estimate.system import System
from .reduced import RIDGE


def condensed(
    rows: Sequence[Series], columns_of: Sequence[Indices], torque: Sequence[Vector], noise: JointVector
) -> System:
    """Give the equations of all joints, weighted, by a Cholesky factor of their products."""
    size = 1 + max(int(columns.max(initial=-1)) for columns in columns_of)
    product, moment, square = np.zeros((size, size)), np.zeros(size), 0.0
    for own, columns, measured, deviation in zip(rows, columns_of, torque, noise, strict=True):
        weight = 1.0 / deviation**2
        product[np.ix_(columns, columns)] += weight * (own @ own.T)
        moment[columns] += weight * (own @ measured)
        square += weight * float(measured @ measured)
    norms = np.sqrt(np.diag(product))
    scale = np.where(norms > 0.0, norms, 1.0)
    upper = cholesky(product / np.outer(scale, scale) + RIDGE * np.eye(size))
    target = solve_triangular(upper, moment / scale, trans="T")
    count = sum(len(measured) for measured in torque)
    return System(upper * scale, target, max(square - float(target @ target), 0.0), count, noise)
