"""Give nuisance columns for stiction: friction is arbitrary while a joint is practically at rest.

While a joint sticks, friction balances the torque, anywhere between minus and plus its level, and the sign of
a measured velocity does not determine it. Polynomials over every such span, with as many coefficients as the
filter passes, represent it, so that rows right beside a reversal remain evidence.
Source: Frisch & Waugh 1933, for nuisance columns.
"""

from itertools import pairwise

import numpy as np
from scipy.sparse import csr_array

from ...arrays import JointVector, Series
from ...dynamics.terms.coupling import motor_speed
from ...dynamics.terms.effect import step_of
from ...numerics.marked_runs import marked_runs
from ...robot.model import RobotModel
from ...signals.state import MotionState
from ..thresholds.dataset import ROWS
from .stretch import Stretch


def rest_mask(state: MotionState, robot: RobotModel, still: JointVector) -> np.ndarray:
    """Mark, samples x joints, where a joint or a motor coupled to it rests or turns round."""
    marks = _is_at_rest(state.velocity, still)
    for coupling in robot.couplings:
        speed = motor_speed(coupling, state)[:, None]
        motor = _is_at_rest(speed, ROWS.still_share * np.sqrt(np.mean(speed**2, axis=0)))
        marks[:, [joint - 1 for joint in coupling.joints]] |= motor
    return marks


def stiction_columns(stretch: Stretch, marks: np.ndarray, band_hz: float) -> tuple[csr_array, ...]:
    """Give, per joint, filtered columns for the friction of every stretch of time in which it rests."""
    band = band_hz * step_of(stretch.state)
    longest = int(ROWS.most_shapes / (ROWS.shapes * band))
    runs = [_cut_runs(_runs(marks[:, joint]), longest) for joint in range(marks.shape[1])]
    return tuple(_columns(stretch, spans, band) for spans in runs)


def _columns(stretch: Stretch, runs: list[tuple[int, int]], band: float) -> csr_array:
    rows, values = [np.zeros(0, dtype=int)], [np.zeros(0)]
    ends = [0]
    for begin, end in runs:
        low, part = stretch.filtered_part(_polynomials(begin, end, band), begin)
        rows.append(np.tile(np.arange(low, low + part.shape[1]), len(part)))
        values.append(part.ravel())
        ends += [ends[-1] + part.shape[1] * (number + 1) for number in range(len(part))]
    by_column = csr_array((np.concatenate(values), np.concatenate(rows), ends), (len(ends) - 1, stretch.kept))
    return by_column.T.tocsr()


def _is_at_rest(velocity: np.ndarray, still: np.ndarray) -> np.ndarray:
    marks = np.abs(velocity) <= still
    marks[1:] |= np.sign(velocity[1:]) != np.sign(velocity[:-1])
    return np.asarray(marks)


def _runs(marks: np.ndarray) -> list[tuple[int, int]]:
    """List where marks begin and end, a sample wider on either side; what then overlaps is one.

    Examples
    --------
    >>> _runs(np.array([False, True, False, False, False])), _runs(np.zeros(5, dtype=bool))
    ([(0, 3)], [])
    """
    first, stop = marked_runs(marks).T
    begins, ends = first - 1, stop + 1
    if not len(begins):
        return []
    apart = np.append(True, begins[1:] > ends[:-1])
    lasts = np.append(np.flatnonzero(apart)[1:] - 1, len(ends) - 1)
    return [
        (max(int(begin), 0), min(int(end), len(marks)))
        for begin, end in zip(begins[apart], ends[lasts], strict=True)
    ]


def _cut_runs(runs: list[tuple[int, int]], longest: int) -> list[tuple[int, int]]:
    """Cut long runs into equal parts.

    Examples
    --------
    >>> _cut_runs([(0, 3), (5, 11)], 3)
    [(0, 3), (5, 8), (8, 11)]
    """
    edges = [np.linspace(begin, end, 1 + -(-(end - begin) // longest)).astype(int) for begin, end in runs]
    return [(int(begin), int(end)) for cuts in edges for begin, end in pairwise(cuts)]


def _polynomials(begin: int, end: int, band: float) -> Series:
    count = min(end - begin, 2 + int(np.ceil(ROWS.shapes * band * (end - begin))))
    shapes = np.polynomial.legendre.legvander(np.linspace(-1.0, 1.0, end - begin), count - 1)
    return np.ascontiguousarray(shapes.T)
