"""Give what noise of the accelerations adds to the products of columns.

To first order, noise of positions enters a column by position, velocity and acceleration. It grows with the
square of frequency on its way to the acceleration, in which columns are linear. On simulated arms the other
two change a bias by less than one per cent of it, and are left out. Source: Fuller, Measurement Error Models
(1987), ch. 3.
"""

import numpy as np

from ..arrays import Indices, JointSeries, JointVector, SquareMatrix
from ..dynamics.model import STANDARD_TERMS
from ..signals.state import MotionState
from .columns import ColumnPlan


def acceleration_columns(plan: ColumnPlan, position: JointSeries) -> np.ndarray:
    """Give the columns per unit of every joint's acceleration: joints x entries of the plan x samples.

    Columns of other than standard terms count as free of noise.
    """
    inner, rows = _standard_part(plan)
    still = np.zeros_like(position)
    at_rest = inner.series(MotionState(position, still, still))
    found = np.zeros((position.shape[1], len(plan.entries), len(position)))
    for joint, columns in enumerate(found):
        moved = still.copy()
        moved[:, joint] = 1.0
        columns[rows] = inner.series(MotionState(position, still, moved)) - at_rest
    return found


def noise_products(plan: ColumnPlan, columns: np.ndarray, variance: JointVector) -> tuple[SquareMatrix, ...]:
    """Give, per joint, the expected products of the noise of one row's columns, mean over the samples.

    Parameters
    ----------
    columns
        Per unit of every joint's acceleration.
    variance
        Of the noise of every joint's acceleration, after all filters.
    """
    noise = columns * np.sqrt(variance)[:, None, None]
    parts = (np.moveaxis(noise[:, rows], 1, 0).reshape(len(rows), -1) for rows in plan.rows_of)
    return tuple(part @ part.T / columns.shape[2] for part in parts)


def _standard_part(plan: ColumnPlan) -> tuple[ColumnPlan, Indices]:
    """Plan for the columns of standard terms alone, with their rows among the plan's."""
    model, known = plan.model, tuple(STANDARD_TERMS.values())
    standard = [isinstance(term, known) for term in model.terms for _ in term.parameters(model.robot)]
    kept = [place for place, column in enumerate(plan.columns) if standard[column]]
    inner = ColumnPlan(model, tuple(plan.columns[place] for place in kept))
    row_of = {entry: row for row, entry in enumerate(plan.entries)}
    return inner, np.array([row_of[joint, kept[own]] for joint, own in inner.entries], dtype=int)
