"""Sum up normal equations block by block of a log, and tell what each block changes in their solution.

The scatter of these changes is that of the estimate, whatever the noise is. Source: Liang & Zeger, Biometrika
73(1), 1986.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from ...arrays import Indices, Matrix, SquareMatrix, Vector
from ..thresholds.checks import BLOCK_SCATTER


@dataclass(eq=False)
class BlockEquations:
    """Sum up the normal equations of a block of rows: products of columns, and with what is left."""

    gram: SquareMatrix
    slope: Vector

    @classmethod
    def empty(cls, width: int) -> "BlockEquations":
        """Give those of no rows."""
        return cls(np.zeros((width, width)), np.zeros(width))

    def add(self, acting: Indices, columns: Matrix, left: Vector) -> None:
        """Add rows of one joint."""
        self.gram[np.ix_(acting, acting)] += columns.T @ columns
        self.slope[acting] += columns.T @ left


@dataclass(frozen=True, eq=False)
class BlockSolution:
    """Solve the equations of some blocks together, with some that belong to no block, as a prior's."""

    blocks: Sequence[BlockEquations]
    known: tuple[BlockEquations, ...] = ()

    @cached_property
    def change(self) -> Vector:
        """Give by how much the values change where these blocks alone are fitted."""
        slope = np.sum([block.slope for block in (*self.blocks, *self.known)], axis=0)
        return self._solved(slope)

    @cached_property
    def left_out(self) -> Matrix:
        """Give by how much the values change where one block after the other is left out, blocks x values.

        A value that the others do not show stays.
        """
        blocks = list(self.blocks)
        others = (BlockSolution(blocks[:at] + blocks[at + 1 :], self.known) for at in range(len(blocks)))
        return np.asarray(np.array([other.change for other in others]) - self.change)

    def deviations(self, weights: Matrix) -> Vector:
        """Give the deviations of weighted sums of the values, along columns, by the scatter of blocks."""
        return np.asarray(np.sqrt(np.diag(self._scatter(weights))))

    def model_deviations(self, weights: Matrix) -> Vector:
        """Give the same by the noise model, under which columns and what is left are white."""
        return np.asarray(np.sqrt(np.einsum("ij,ij->j", weights, self._solved(weights))))

    def covariance(self, weights: Matrix) -> SquareMatrix:
        """Give the covariance of weighted sums by the scatter of blocks, no less than the noise model's."""
        found = self._scatter(weights)
        least, deviations = self.model_deviations(weights), np.sqrt(np.diag(found))
        larger = np.maximum(least / np.maximum(deviations, np.finfo(float).tiny), 1.0)
        scattered = deviations > 0.0
        return np.where(np.outer(scattered, scattered), found * np.outer(larger, larger), np.diag(least**2))

    def _scatter(self, weights: Matrix) -> SquareMatrix:
        along = self._solved(weights)
        moved = np.array([along.T @ (block.slope - block.gram @ self.change) for block in self.blocks])
        return np.asarray(moved.T @ moved * len(moved) / (len(moved) - 1))

    def _solved(self, right: np.ndarray) -> np.ndarray:
        factor, scale = self._factor
        scales = scale if right.ndim == 1 else scale[:, None]
        return np.asarray(cho_solve(factor, right / scales) / scales)

    @cached_property
    def _factor(self) -> tuple[tuple[np.ndarray, bool], Vector]:
        gram = np.sum([block.gram for block in (*self.blocks, *self.known)], axis=0)
        squares = np.diag(gram)
        scale = np.sqrt(np.where(squares > 0.0, squares, 1.0))
        return cho_factor(gram / np.outer(scale, scale) + BLOCK_SCATTER.ridge * np.eye(len(gram))), scale
