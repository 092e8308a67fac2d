"""Give what a believed model leaves of the filtered torque: a cause's first look at when and how much.

A first look only settles where to search; what counts is judged on the complement of the fitted columns.
"""

import numpy as np

from core.arrays import Indices, JointSeries, JointVector, Vector
from core.diagnosis.free import free_of, independent
from core.diagnosis.look import Look
from core.diagnosis.noise import learn_noise, places
from core.dynamics.prediction import Prediction


def misfit(look: Look, believed: Prediction) -> JointSeries:
    """Give measured minus predicted torque, N m or N, rows x joints."""
    left = look.torque.copy()
    for stretch in look.stretches:
        left[stretch.rows] -= stretch.filtered(believed.torque(stretch.state).T).T
    return left


def fitted_rows(look: Look) -> np.ndarray:
    """Mark, rows x joints, what a fit may see: clear of reversals and not held out."""
    return np.asarray(look.clear & ~look.held_out[:, None])


def whitened_by_joint(
    look: Look, columns: np.ndarray, left: JointSeries, mask: np.ndarray
) -> tuple[np.ndarray, JointSeries]:
    """Whiten columns (rows x columns x joints) and a misfit, the noise learned from its quieter half.

    What happens once in a while is not to be learned as noise.
    """
    place = places(~look.starts)
    columns, left = columns.copy(), left.copy()
    for joint in range(look.joints):
        free = free_of(independent(look.sticking[joint]))
        left[:, [joint]] = free.cleared(left[:, [joint]])
        rows = _quiet(look, left[:, joint], np.flatnonzero(mask[:, joint]))
        follows = (np.diff(rows, prepend=-2) == 1) & ~look.starts[rows]
        noise = learn_noise(left[rows, joint], places(follows))
        columns[:, :, joint] = noise.whitened(columns[:, :, joint], place)
        left[:, joint] = noise.whitened(left[:, [joint]], place)[:, 0]
    return columns, left


def _quiet(look: Look, left: Vector, rows: Indices) -> Indices:
    """Keep the rows of the blocks in which a misfit is smaller than in half of them."""
    if not len(rows):
        return rows
    block = look.block_of_all[rows]
    counts = np.maximum(np.bincount(block), 1)
    power = np.bincount(block, left[rows] ** 2) / counts
    return np.asarray(rows[power[block] <= np.median(power[np.unique(block)])])


def size_of(left: JointSeries, mask: np.ndarray) -> JointVector:
    """Give the RMS of the marked rows per joint, never zero."""
    counts = np.maximum(mask.sum(axis=0), 1)
    return np.asarray(np.sqrt(np.maximum((left**2 * mask).sum(axis=0) / counts, 1e-24)))
