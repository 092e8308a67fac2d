"""Fit by iteratively reweighted least squares: rows that no model of this kind explains are weighted down.

A row whose residual exceeds 1.345 joint noises counts in proportion to the excess, so that spikes and
collisions pull no parameter. Residuals are computed again tile by tile; nothing is stored. Source: Huber
1981; Holland & Welsch 1977.
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import BaseParameters, Indices, JointVector, Parameters, Samples, Weights
from ...regressor.factor import FilteredRows, Weigh
from ..system import stacked, weighted
from .method import FitData, Step

HUBER = 1.345
ROUNDS = 3


@dataclass(frozen=True)
class IterativelyReweighted:
    """Weight the equations per joint and, by Huber's function, per row."""

    name: str = "irls"
    title: str = "robust, may be inconsistent"
    needs: tuple[str, ...] = ()
    feasible: bool = False
    iterative: bool = False
    sources: tuple[str, ...] = ()
    row_weights: bool = True

    def equations(self, at: Parameters | None, data: FitData) -> Step:  # noqa: ARG002  (the same at any robot)
        """Write the equations, which are the same at any robot."""
        return huber_equations(data.discounted())


def huber_equations(data: FitData) -> Step:
    """Weight rows by the residuals of the fit before, in a fixed number of rounds."""
    system = weighted(data.factors, data.columns_of, data.size)
    for _ in range(ROUNDS):
        data = data.weighted(_huber_weights(system.solved(), data.columns_of, system.noise))
        system = stacked(data.factors, data.columns_of, data.size, system.noise)
    return Step(system, data)


def _huber_weights(base: BaseParameters, columns_of: tuple[Indices, ...], noise: JointVector) -> Weigh:
    """Give the row weights (to be applied to rows, so the roots of Huber's) that these parameters suggest."""

    def weigh(pairs: list[FilteredRows]) -> list[Weights]:
        return [
            _root_weight(rows[:, -1] - rows[:, :-1] @ base[columns], sigma)
            for (rows, _), columns, sigma in zip(pairs, columns_of, noise, strict=True)
        ]

    return weigh


def _root_weight(residual: Samples, noise: float) -> Samples:
    size = np.maximum(np.abs(residual), 1e-300)
    return np.asarray(np.sqrt(np.minimum(1.0, HUBER * noise / size)))
