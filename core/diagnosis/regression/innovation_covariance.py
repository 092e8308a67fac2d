"""Give the residual at the operating point and the inverse covariance of its noise.

Transient causes use both to find where to search. They are tested on the complement of the fitted columns.
"""

import numpy as np
from scipy.sparse import csr_array

from ...arrays import Indices, JointSeries, UsableRows, Vector
from ...dynamics.prediction import Prediction
from ..dataset.dataset import Dataset
from .ar_noise import fit_ar_noise, run_indices

MIDDLE = 1.4826
"""Deviation of normal numbers over their median size."""


def torque_residual(dataset: Dataset, operating_point: Prediction) -> JointSeries:
    """Give measured minus predicted torque, N m or N, rows x joints."""
    left = dataset.torque.copy()
    for stretch in dataset.stretches:
        left[stretch.rows] -= stretch.filtered(operating_point.torque(stretch.state).T).T
    return left


def fitted_rows(dataset: Dataset) -> np.ndarray:
    """Mark, rows x joints, what a fit may see: clear of reversals and not held out."""
    return np.asarray(dataset.clear & ~dataset.held_out[:, None])


def inverse_covariances(dataset: Dataset, left: JointSeries, mask: np.ndarray) -> tuple[csr_array, ...]:
    """Give, per joint, the inverse covariance of a residual's noise over the marked rows; zero elsewhere.

    The noise is estimated from the blocks with the smaller innovations, so that transients are not absorbed.
    Innovations decide, since slow noise is large for a while by itself. The median innovation of all rows
    gives its size: the chosen blocks are quieter than the rest.
    """
    out = []
    for joint in range(dataset.joints):
        rows = np.flatnonzero(mask[:, joint])
        run_index = run_indices(dataset.follows(rows))
        new = fit_ar_noise(left[rows, joint], run_index).innovations(left[rows, joint], run_index)
        quiet = rows[_quiet_rows(dataset, new, rows)]
        noise = fit_ar_noise(left[quiet, joint], run_indices(dataset.follows(quiet)))
        white = noise.whitening(run_index)
        size = MIDDLE * _median_size(noise.innovations(left[rows, joint], run_index))
        white = csr_array((white.data / size, rows[white.indices], white.indptr), (len(rows), len(left)))
        out.append((white.T @ white).tocsr())
    return tuple(out)


def _median_size(values: Vector) -> float:
    """Give the median size, one where there is none: a dead channel has no noise."""
    return float(np.median(np.abs(values))) or 1.0 if len(values) else 1.0


def _quiet_rows(dataset: Dataset, left: Vector, rows: Indices) -> UsableRows:
    """Mark the rows of the blocks in which what is left is smaller than in half of them."""
    if not len(rows):
        return np.zeros(0, dtype=bool)
    block = dataset.block_of_all[rows]
    counts = np.maximum(np.bincount(block), 1)
    power = np.bincount(block, left**2) / counts
    return np.asarray(power[block] <= np.median(power[np.unique(block)]))
