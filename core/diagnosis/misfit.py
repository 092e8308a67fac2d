"""Give what a believed model leaves of the filtered torque: a cause's first look at when and how much.

A first look only settles where to search; what counts is judged on the complement of the fitted columns.
"""

import numpy as np

from core.arrays import JointSeries, JointVector
from core.diagnosis.look import Look
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


def size_of(left: JointSeries, mask: np.ndarray) -> JointVector:
    """Give the RMS of the marked rows per joint, never zero."""
    counts = np.maximum(mask.sum(axis=0), 1)
    return np.asarray(np.sqrt(np.maximum((left**2 * mask).sum(axis=0) / counts, 1e-24)))
