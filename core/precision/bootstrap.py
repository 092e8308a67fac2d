"""Draw the log again, block by block: intervals for an estimate that its constraints make one-sided.

Contiguous blocks longer than the residual's memory are drawn with replacement and the programme is solved
again on the sum of their factors; no sample is ever visited again. Source: Kunsch 1989 (block bootstrap).
"""

from collections.abc import Callable

import numpy as np

from ..arrays import BaseParameters, BlockDraws, Indices, Matrix
from ..errors import ExcitationError, SolverError
from ..estimate.system import System
from ..numerics.mapping import SERIAL, Mapper
from ..regressor.factor import Factor


def bootstrap(
    system: System,
    blocks: tuple[tuple[Factor, ...], ...],
    columns_of: tuple[Indices, ...],
    solve: Callable[[System], BaseParameters],
    drawn: BlockDraws,
    mapper: Mapper = SERIAL,
) -> Matrix:
    """Give one row of base parameters per draw.

    Parameters
    ----------
    system
        The weighted equations; its noise weighs the draws too.
    blocks
        Per fitted block, one factor per joint.
    solve
        Fits a system.
    drawn
        Per draw, the indices of its blocks.
    mapper
        Runs the draws' fits.

    Notes
    -----
    Draws that have no accurate optimum, or less excitation than noise, are left out; the caller sees fewer
    rows.
    """
    products = _products(blocks, columns_of, system)

    def fit_draw(indices: Indices) -> BaseParameters | None:
        weights = np.bincount(indices, minlength=len(blocks)).astype(float)
        try:
            product = np.tensordot(weights, products, axes=1)
            return solve(system.criterion.system(_triangle(product), system.rows, system.noise))
        except (SolverError, ExcitationError):
            return None

    answers = mapper.map(fit_draw, drawn)
    solved = [answer for answer in answers if answer is not None]
    return np.array(solved).reshape(len(solved), system.triangle.shape[1])


def _products(
    blocks: tuple[tuple[Factor, ...], ...], columns_of: tuple[Indices, ...], system: System
) -> np.ndarray:
    base, criterion = system.triangle.shape[1], system.criterion
    size = criterion.width(base)
    products = np.zeros((len(blocks), size, size))
    for total, block in zip(products, blocks, strict=True):
        for factor, columns, noise in zip(block, columns_of, system.noise, strict=True):
            index = criterion.place(columns, base)
            total[np.ix_(index, index)] += factor.triangle.T @ factor.triangle / noise**2
    return products


def _triangle(product: Matrix) -> Matrix:
    """Give the triangular factor of rows of which this is the product with themselves."""
    values, vectors = np.linalg.eigh(product)
    rows = np.sqrt(np.maximum(values, 0.0))[:, None] * vectors.T
    return Factor.of(np.vstack([rows, np.zeros((1, len(product)))])).triangle
