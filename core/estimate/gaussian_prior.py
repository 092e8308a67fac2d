"""Hold a normal prior of coefficients in the form of further rows.

A normal distribution about an earlier estimate is equal to equations whose errors have unit variance.
Source: Gelman et al., Bayesian Data Analysis (2013), ch. 14.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Matrix, Vector, Weights


@dataclass(frozen=True, eq=False)
class GaussianPrior:
    """Hold a normal prior of the first columns: equations of unit variance, rows @ values = target."""

    rows: Matrix
    target: Vector

    def departure(self, values: Weights) -> float:
        """Give the squared distance of coefficients from it, in standard deviations."""
        return float(np.sum((self.target - self.rows @ values[: self.rows.shape[1]]) ** 2))

    def slope(self, values: Weights) -> Weights:
        """Give minus half the gradient of that distance, for all coefficients."""
        out = np.zeros(len(values))
        size = self.rows.shape[1]
        out[:size] = self.rows.T @ (self.target - self.rows @ values[:size])
        return out
