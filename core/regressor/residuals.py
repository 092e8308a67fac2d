"""Recompute what parameters leave of the filtered torque, tile after tile: nothing of it is stored."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..arrays import BaseParameters, JointSeries, Samples
from ..signals.condition import Motion
from ..signals.parallel import Tile
from .columns import ColumnPlan


def compare(plan: ColumnPlan, tile: Tile, parameters: BaseParameters) -> tuple[JointSeries, JointSeries]:
    """Give a tile's filtered torque, and what parameters over the plan's columns leave of it, N m.

    The filter is linear: one prediction per joint is filtered in the place of all its columns.
    """
    series = plan.series(tile.state)
    parts = zip(plan.rows_of, plan.columns_of, strict=True)
    predicted = np.stack([parameters[columns] @ series[rows] for rows, columns in parts])
    torque = tile.filtered(np.ascontiguousarray(tile.torque.T))
    return torque.T, (torque - tile.filtered(predicted)).T


@dataclass(frozen=True, eq=False)
class ResidualTile:
    """Carry filtered torque and residual (measured minus predicted), N m, of all joints, decimated."""

    time: Samples
    torque: JointSeries
    residual: JointSeries
    usable: np.ndarray


def residuals(plan: ColumnPlan, motion: Motion, parameters: BaseParameters) -> Iterator[ResidualTile]:
    """Recompute the residuals from parameters over the plan's columns, tile after tile."""
    for tile in motion.tiles():
        torque, residual = compare(plan, tile, parameters)
        yield ResidualTile(tile.time, torque, residual, tile.usable)
