"""Take out of the products of columns what their noise adds to them.

W'W of noisy columns is on the average that of the true ones plus C, the expected products of their noise.
(W'W - C) chi = W'y then has no bias of first order, as least squares has. It is solved as least squares: with
the triangular factor R of W, W'W - C = R'(I - R'^-1 C R^-1) R. Source: Fuller, Measurement Error Models
(1987), ch. 3.1.
"""

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import JointVector, Matrix, SquareMatrix
from ..errors import ExcitationError
from .system import RANK_TOLERANCE, LeastSquares, System, column_scale


@dataclass(frozen=True, eq=False)
class Compensated(LeastSquares):
    """Minimise ||y - W base||^2 - base' C base over rows [W y]."""

    products: np.ndarray
    """Per joint, the expected products of the noise of all its rows: joints x base columns x base columns."""

    def system(self, whole: Matrix, rows: int, noise: JointVector) -> System:
        """Write the equations of the triangular factor of all rows, square.

        Raises
        ------
        ExcitationError
            If some combination of the parameters moves the columns less than noise does.
        """
        plain = super().system(whole, rows, noise)
        added = np.tensordot(noise**-2.0, self.products, axes=1)
        values, vectors = np.linalg.eigh(_share(plain.triangle, added))
        if values[-1] >= 1.0:
            raise ExcitationError(
                "noise exceeds excitation: some combination of the parameters shows less than noise of the "
                "positions does",
                evidence={"noise_over_whole": float(values[-1])},
                remedy="lower filter.cutoff_hz, record larger accelerations, or ask for estimator didim",
            )
        left = np.linalg.cholesky(np.eye(len(values)) - vectors * values @ vectors.T).T
        answer = replace(
            plain,
            triangle=left @ plain.triangle,
            target=np.linalg.solve(left.T, plain.target),
            rest=0.0,
            criterion=self,
        )
        return replace(answer, rest=plain.cost(answer.solved()))


def _share(triangle: Matrix, added: SquareMatrix) -> SquareMatrix:
    """Give R'^-1 C R^-1 in the directions that the columns show at all; the prior decides on all others."""
    scale = column_scale(triangle)
    left, sizes, right = np.linalg.svd(triangle / scale)
    shown = sizes > RANK_TOLERANCE * sizes[0]
    turned = left[:, shown] / sizes[shown] @ right[shown] / scale
    share = turned @ added @ turned.T
    return np.asarray(0.5 * (share + share.T))
