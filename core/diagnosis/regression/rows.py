"""Take the rows of a data set joint by joint: columns, torque and nuisance columns."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

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
    columns: Matrix
    torque: Vector
    """What is fitted, and what it is fitted to."""
    nuisance: Nuisance
    """Nuisance columns: friction while the joint sticks."""

    @cached_property
    def acting(self) -> Indices:
        """List the columns that are not all zero on the rows."""
        return np.flatnonzero(self.columns.any(axis=0))

    @cached_property
    def acting_columns(self) -> EquationRows:
        """Give those columns."""
        return np.ascontiguousarray(self.columns[:, self.acting])

    def residual(self, values: Weights) -> Vector:
        """Give the residual of the columns, on the complement of the nuisance columns."""
        left = self.torque - self.columns @ values
        return self.nuisance.without_nuisance(left[:, None])[:, 0]


def rows_of_joints(dataset: Dataset, columns: Sequence[Matrix], mask: np.ndarray) -> tuple[JointRows, ...]:
    """Take, per joint, the rows that a mask (rows x joints) allows."""
    out = []
    for joint in range(dataset.joints):
        rows = np.flatnonzero(mask[:, joint])
        out.append(
            JointRows(
                rows,
                run_indices(dataset.follows(rows)),
                columns[joint][rows],
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
        parts = [rows.columns]
        for own, width in zip(columns, widths, strict=True):
            parts.append(own[joint][rows.rows] if joint in own else np.zeros((len(rows.rows), width)))
        out.append(replace(rows, columns=np.hstack(parts)))
    return tuple(out)
