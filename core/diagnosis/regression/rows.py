"""Take the rows of a data set joint by joint: columns, torque and nuisance columns."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...arrays import EquationRows, Indices, Matrix, Vector, Weights
from ..dataset.dataset import Dataset
from .ar_noise import run_indices
from .nuisance import Nuisance, independent_nuisance

Columns = Mapping[int, EquationRows]
"""Per joint (from 0), rows x columns; a joint that is left out has zeros."""


@dataclass(frozen=True, eq=False)
class JointRows:
    """Hold the rows of one joint that a fit may use."""

    rows: Indices
    run_index: Indices
    """Which rows of the data set, and their indices within runs."""
    size: int
    """Number of columns of all joints together."""
    acting: Indices
    """Which of them are not all zero on the rows, in rising order."""
    columns: EquationRows
    torque: Vector
    """Those columns, and what they are fitted to."""
    nuisance: Nuisance
    """Nuisance columns: friction while the joint sticks."""

    def left(self, values: Weights) -> Vector:
        """Give what all columns leave of the torque, N m or N."""
        return np.asarray(self.torque - self.columns @ values[self.acting])

    def residual(self, values: Weights) -> Vector:
        """Give the residual of the columns, on the complement of the nuisance columns."""
        return self.nuisance.without_nuisance(self.left(values)[:, None])[:, 0]


def rows_of_joints(dataset: Dataset, columns: Sequence[Matrix], mask: np.ndarray) -> tuple[JointRows, ...]:
    """Take, per joint, the rows that a mask (rows x joints) allows."""
    out = []
    for joint in range(dataset.joints):
        rows = np.flatnonzero(mask[:, joint])
        own = columns[joint][rows]
        acting = np.flatnonzero(own.any(axis=0))
        out.append(
            JointRows(
                rows,
                run_indices(dataset.follows(rows)),
                own.shape[1],
                acting,
                np.ascontiguousarray(own[:, acting]),
                dataset.torque[rows, joint],
                independent_nuisance(dataset.sticking[joint][rows]),
            )
        )
    return tuple(out)


def append_columns(joints: tuple[JointRows, ...], columns: Sequence[Columns]) -> tuple[JointRows, ...]:
    """Append further columns, given over all rows of the data set."""
    widths = [next(iter(own.values())).shape[1] for own in columns]
    out = []
    for joint, rows in enumerate(joints):
        size, acting, parts = rows.size, [rows.acting], [rows.columns]
        for own, width in zip(columns, widths, strict=True):
            if joint in own:
                part = own[joint][rows.rows]
                acts = part.any(axis=0)
                acting.append(size + np.flatnonzero(acts))
                parts.append(part[:, acts])
            size += width
        out.append(replace(rows, size=size, acting=np.concatenate(acting), columns=np.hstack(parts)))
    return tuple(out)
