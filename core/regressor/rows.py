"""Make the rows of a fit, joint by joint and tile by tile, out of motions."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol, runtime_checkable

import numpy as np

from ..arrays import Indices
from ..signals.parallel import Tile
from .columns import ColumnPlan
from .factor import INSTRUMENT, REGRESSOR, TARGET, FilteredRows, Groups


@runtime_checkable
class Tiled(Protocol):
    """Give motion tile by tile, as it was measured or otherwise known."""

    @property
    def kept(self) -> int:
        """Count the decimated samples."""

    def tiles(self) -> Iterator[Tile]:
        """Go through the motion once."""


@runtime_checkable
class RowSource(Protocol):
    """Say what the rows of every joint are."""

    @property
    def columns_of(self) -> tuple[Indices, ...]:
        """Give, per joint, the base parameters that its columns belong to."""

    @property
    def groups(self) -> tuple[Groups, ...]:
        """Give, per joint, what the columns of its rows are."""

    def rows(self, number: int, motion: Tiled) -> Iterator[tuple[Tile, list[FilteredRows]]]:
        """Go through the motion of a number: its tiles, and each one's rows per joint."""


@dataclass(frozen=True, eq=False)
class MeasuredRows:
    """Make rows [w y] of the columns of the motion itself."""

    plan: ColumnPlan

    @property
    def columns_of(self) -> tuple[Indices, ...]:
        """Give, per joint, its columns that are not zero."""
        return self.plan.columns_of

    @cached_property
    def groups(self) -> tuple[Groups, ...]:
        """Give, per joint, what the columns of its rows are."""
        return tuple(((REGRESSOR, len(columns)), (TARGET, 1)) for columns in self.columns_of)

    def rows(self, number: int, motion: Tiled) -> Iterator[tuple[Tile, list[FilteredRows]]]:  # noqa: ARG002  (all are alike)
        """Go through a motion."""
        for tile in motion.tiles():
            yield tile, list(equations(self.plan, tile))


@dataclass(frozen=True, eq=False)
class InstrumentedRows:
    """Make rows [z w y]: the columns of the same motions otherwise known stand before their own."""

    plan: ColumnPlan
    instruments: Sequence[Tiled]
    """The motions as the instruments know them."""

    @property
    def columns_of(self) -> tuple[Indices, ...]:
        """Give, per joint, its columns that are not zero."""
        return self.plan.columns_of

    @cached_property
    def groups(self) -> tuple[Groups, ...]:
        """Give, per joint, what the columns of its rows are."""
        widths = [len(columns) for columns in self.columns_of]
        return tuple(((INSTRUMENT, width), (REGRESSOR, width), (TARGET, 1)) for width in widths)

    def rows(self, number: int, motion: Tiled) -> Iterator[tuple[Tile, list[FilteredRows]]]:
        """Go through a motion and its other form side by side."""
        for tile, other in zip(motion.tiles(), self.instruments[number].tiles(), strict=True):
            pairs = zip(equations(self.plan, tile), equations(self.plan, other), strict=True)
            yield (
                tile,
                [
                    (np.hstack([beside[:, :-1], rows]), usable & known)
                    for (rows, usable), (beside, known) in pairs
                ],
            )


def equations(plan: ColumnPlan, tile: Tile) -> Iterator[FilteredRows]:
    """Give, joint by joint, the filtered rows [W y] of a tile with the mask of usable ones."""
    if plan.is_instantaneous:
        filtered = tile.filtered_in_parts(plan.series)
    else:
        filtered = tile.filtered(plan.series(tile.state))
    torque = tile.filtered(np.ascontiguousarray(tile.torque.T))
    for joint, rows in enumerate(plan.rows_of):
        both = np.empty((len(tile.time), len(rows) + 1))
        both[:, :-1], both[:, -1] = filtered[rows].T, torque[joint]
        yield both, tile.usable[:, joint]
