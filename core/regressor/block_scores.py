"""Tell how certain equations are by how far whole blocks of them agree, whatever the rows of a block share.

Rows of a filter have unit variance where its model holds. What the model lacks is alike for many of them, and
they claim too much. The score of a block, T'(z - T chi), has the block's information as its covariance if
they do not. The mean over blocks and parameters of its square in these units is the factor by which the
variances have to grow. Source: McCullagh & Nelder (1989), ch. 9 (overdispersion); Liang & Zeger 1986.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Matrix, Parameters, Vector
from .factor import REGRESSOR, TARGET, Factor

_RANK_TOLERANCE = 1e-8


@dataclass(frozen=True, eq=False)
class BlockScores:
    """Hold the factors of blocks over all parameters, with the measures that lagged products have."""

    blocks: tuple[Factor, ...]
    instruments: int = 0

    @property
    def rows(self) -> int:
        """Count blocks less the one that the fit takes."""
        return max(len(self.blocks) - 1, 1)

    @property
    def information(self) -> Matrix:
        """Give the information of all blocks."""
        return np.asarray(sum(block.columns(REGRESSOR).T @ block.columns(REGRESSOR) for block in self.blocks))

    @property
    def of_regressor(self) -> np.ndarray:
        """Give nothing: what a fit takes is taken off the number of blocks."""
        return np.zeros((1, *self.information.shape))

    def autocovariance(self, parameters: Parameters) -> Vector:
        """Sum the squares of the blocks' scores over their information, per parameter."""
        parts = [(block.columns(REGRESSOR), block.columns(TARGET)[:, 0]) for block in self.blocks]
        scores = np.array([columns.T @ (target - columns @ parameters) for columns, target in parts])
        information = self.information
        size = np.sqrt(np.diag(information))
        scale = np.where(size > 0.0, size, 1.0)
        values, vectors = np.linalg.eigh(information / np.outer(scale, scale))
        excited = values > _RANK_TOLERANCE**2 * values[-1]
        white = (scores / scale) @ vectors[:, excited] / np.sqrt(values[excited])
        return np.array([len(self.blocks) * float(np.sum(white**2)) / white.shape[1]])

    def spread(self, autocovariance: Vector) -> Matrix:
        """Give the covariance of the sum of all scores."""
        return np.asarray(autocovariance[0] * self.information)
