"""Combine the joints' rows of an instant so that their errors are independent and alike.

Noise of one acceleration enters the rows of all joints that its inertia couples. With the mass matrix M, the
errors of the rows of an instant have the covariance T + M A M', T being that of the torques' noise and A that
of the accelerations'. With its triangular factor L, the rows L^-1 [W y] have errors of unit covariance.
Source: Aitken 1935 (generalised least squares); Fuller, Measurement Error Models (1987), ch. 3.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import BaseParameters, Indices, JointMarks, JointVector, SampleMask
from ..signals.parallel import Tile
from .column_noise import acceleration_columns
from .columns import ColumnPlan
from .factor import REGRESSOR, TARGET, FilteredRows, Groups
from .rows import Tiled, equations


@dataclass(frozen=True, eq=False)
class WhitenedRows:
    """Make rows [w y] that are combined; every row then has all columns."""

    plan: ColumnPlan
    base: BaseParameters
    """The parameters that give the mass matrix."""
    torque: JointVector
    acceleration: JointVector
    """RMS noise of the joints' filtered torques and accelerations."""
    residual: JointVector
    """RMS of the joints' residuals, by which the combined rows are scaled: they stay torques, N m."""
    skips_turning: JointMarks
    """Joints whose rows beside reversals are left out."""

    @cached_property
    def columns_of(self) -> tuple[Indices, ...]:
        """Give all columns for every joint."""
        return (np.arange(len(self.base)),) * len(self.torque)

    @cached_property
    def groups(self) -> tuple[Groups, ...]:
        """Give, per joint, what the columns of its rows are."""
        return (((REGRESSOR, len(self.base)), (TARGET, 1)),) * len(self.torque)

    def rows(self, number: int, motion: Tiled) -> Iterator[tuple[Tile, list[FilteredRows]]]:  # noqa: ARG002  (all are alike)
        """Go through a motion."""
        for tile in motion.tiles():
            yield tile, list(self.combined(tile, equations(self.plan, tile)))

    def combined(self, tile: Tile, rows: Iterable[FilteredRows]) -> Iterator[FilteredRows]:
        """Combine the rows of a tile."""
        own = list(rows)
        wide = np.zeros((len(tile.time), len(own), len(self.base) + 1))
        joints, columns = self._places
        for joint, (values, _) in enumerate(own):
            wide[:, joint, columns[joints == joint]] = values[:, :-1]
            wide[:, joint, -1] = values[:, -1]
        combined = self._whitening(tile) @ wide
        known = self._known(tile)
        for joint in range(len(own)):
            yield combined[:, joint], known[:, joint]

    def noise_products(self, tile: Tile, wanted: SampleMask) -> np.ndarray:
        """Sum, per joint, the expected products of the noise of some combined rows of a tile."""
        whitening = self._whitening(tile)[wanted]
        total = np.zeros((len(self.torque), len(self.base), len(self.base)))
        for part, noise in zip(self._per_acceleration(tile), self.acceleration, strict=True):
            rows = noise * whitening @ part[wanted]
            total += np.einsum("tja,tjb->jab", rows, rows, optimize=True)
        return total

    def _known(self, tile: Tile) -> np.ndarray:
        return np.asarray(tile.usable & ~(tile.turning & self.skips_turning))

    def _whitening(self, tile: Tile) -> np.ndarray:
        """Give what combines the rows of every instant; joints that are not known there have no part."""
        mass = np.stack([part @ self.base for part in self._per_acceleration(tile)], axis=2)
        spread = mass * self.acceleration
        covariance = spread @ np.swapaxes(spread, 1, 2) + np.diag(self.torque**2)
        known = self._known(tile)
        covariance = np.where(known[:, :, None] & known[:, None, :], covariance, np.diag(self.residual**2))
        diagonal = np.eye(len(self.torque)) * known[:, None, :]
        return np.asarray(self.residual[:, None] * np.linalg.solve(np.linalg.cholesky(covariance), diagonal))

    def _per_acceleration(self, tile: Tile) -> Iterator[np.ndarray]:
        """Give the columns per unit of every acceleration: instants x joints x columns."""
        at = tile.first + tile.parallel.decimation * np.arange(len(tile.time))
        joints, columns = self._places
        for series in acceleration_columns(self.plan, tile.state.position[at]):
            wide = np.zeros((len(at), len(self.torque), len(self.base)))
            wide[:, joints, columns] = series.T
            yield wide

    @cached_property
    def _places(self) -> tuple[Indices, Indices]:
        """Give joint and column of every entry."""
        joints, columns = np.array(self.plan.entries).T
        return joints, columns
