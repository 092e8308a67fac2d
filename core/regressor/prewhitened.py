"""Take out of every row what the rows before it tell of its error.

Filtered errors resemble those before them. An autoregression per joint predicts them; what it leaves of
columns and torque alike is a true equation whose errors are nearly white. Runs of consecutive rows begin with
predictors of lower order. Sources: Brunot, Janot, Young & Carrillo, Control Engineering Practice 74 (2018);
Brockwell & Davis, Time Series (1991), ch. 5.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_toeplitz

from ..arrays import EquationRows, Indices, JointMarks, SquareMatrix, UsableRows, Vector
from ..signals.parallel import Tile
from .factor import FilteredRows, Groups
from .rows import RowSource, Tiled

_RIDGE = 1e-9
"""Share of the variance that is white at least, so that smooth errors have predictors too."""


@dataclass(frozen=True, eq=False)
class PrewhitenedRows:
    """Prewhiten the rows of another source."""

    plain: RowSource
    predictors: tuple[SquareMatrix, ...]
    """Per joint, the weights of a row and of those before it, for 0, 1, ... known ones."""
    skips_turning: JointMarks
    """Joints whose rows beside reversals are left out."""

    @property
    def columns_of(self) -> tuple[Indices, ...]:
        """Give, per joint, the base parameters that its columns belong to."""
        return self.plain.columns_of

    @property
    def groups(self) -> tuple[Groups, ...]:
        """Give, per joint, what the columns of its rows are."""
        return self.plain.groups

    def rows(self, number: int, motion: Tiled) -> Iterator[tuple[Tile, list[FilteredRows]]]:
        """Go through a motion."""
        for tile, rows in self.plain.rows(number, motion):
            yield tile, list(self._prewhitened(tile, rows))

    def _prewhitened(self, tile: Tile, rows: Iterable[FilteredRows]) -> Iterator[FilteredRows]:
        for joint, (values, usable) in enumerate(rows):
            known = usable & ~(tile.turning[:, joint] & self.skips_turning[joint])
            yield prewhitened(values, known, tile.block, self.predictors[joint]), known


def predictors(autocovariance: Vector) -> SquareMatrix:
    """Give the weights that turn errors into innovations of their own variance, for 0, 1, ... known ones.

    Examples
    --------
    White errors are left as they are:

    >>> predictors(np.array([2.0, 0.0])) + 0.0
    array([[1., 0.],
           [1., 0.]])

    Where there are none, such as on a joint that has no rows, there is nothing to predict:

    >>> predictors(np.zeros(2))
    array([[1., 0.],
           [1., 0.]])
    """
    order = len(autocovariance) - 1
    weights = np.zeros((order + 1, order + 1))
    if not autocovariance[0] > 0.0:
        weights[:, 0] = 1.0
        return weights
    variance = autocovariance[0] * (1.0 + _RIDGE)
    for known in range(order + 1):
        past = autocovariance[1 : known + 1]
        column = np.append(variance, autocovariance[1:known])[:known]
        own = solve_toeplitz(column, past) if known else past
        left = max(variance - float(own @ past), _RIDGE * variance)
        weights[known, : known + 1] = np.append(1.0, -own) * np.sqrt(variance / left)
    return weights


def prewhitened(rows: EquationRows, known: UsableRows, block: Indices, weights: SquareMatrix) -> EquationRows:
    """Prewhiten rows, run by run of those that are known and of one block."""
    count = _past(known, block)
    out = np.zeros_like(rows)
    for lag in range(len(weights)):
        share = weights[np.minimum(count, len(weights) - 1), lag] * known
        out[lag:] += share[lag:, None] * rows[: len(rows) - lag]
    return out


def _past(known: UsableRows, block: Indices) -> Indices:
    """Count the rows of its run that lie before every row.

    Examples
    --------
    >>> _past(np.array([True, True, False, True, True, True]), np.array([0, 0, 0, 0, 0, 1]))
    array([0, 1, 0, 0, 1, 0])
    """
    index = np.arange(len(known))
    follows = known & np.append(False, known[:-1]) & (np.diff(block, prepend=block[:1]) == 0)
    return np.asarray(index - np.maximum.accumulate(np.where(follows, 0, index)))
