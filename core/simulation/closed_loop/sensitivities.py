"""Differentiate simulated motion: how torque or position along a log change with every base parameter.

The robot is simulated once as it is and once with each parameter changed a little, side by side and tile by
tile. A difference of two runs over the change is a column. With what the log shows beyond the simulation as
target, least squares over these columns is one Gauss-Newton step. Source: Walter & Pronzato, Identification
of Parametric Models (1997), ch. 4.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import tee

import numpy as np

from ...arrays import BaseParameters, Indices, JointSeries, KeptSeries
from ...regressor.factor import REGRESSOR, TARGET, FilteredRows, Groups
from ...regressor.rows import Tiled
from ...signals.parallel import Tile
from .loop import Played
from .simulated import SimulatedMotion


@dataclass(frozen=True, eq=False)
class Sensitivities:
    """Make rows [J, r + J base]: derivatives J of an output at a robot, and what the log shows beyond it."""

    base: BaseParameters
    """The robot's base parameters."""
    changes: BaseParameters
    """By how much each of them is changed."""
    simulated: Sequence[Sequence[SimulatedMotion]]
    """Per motion, the robot as it is, and with every base parameter changed."""
    of_torque: bool
    """Whether the output is the torque, not the position."""

    @cached_property
    def columns_of(self) -> tuple[Indices, ...]:
        """Give, per joint, the base parameters that its columns belong to: each moves every joint."""
        return (np.arange(len(self.base)),) * self.simulated[0][0].mechanism.joints

    @cached_property
    def groups(self) -> tuple[Groups, ...]:
        """Give, per joint, what the columns of its rows are."""
        return (((REGRESSOR, len(self.base)), (TARGET, 1)),) * len(self.columns_of)

    def rows(self, number: int, motion: Tiled) -> Iterator[tuple[Tile, list[FilteredRows]]]:
        """Go through a motion and all its simulations side by side."""
        runs = self.simulated[number]
        measured, *streams = tee(motion.tiles(), len(runs) + 1)
        played = (run.along(stream) for run, stream in zip(runs, streams, strict=True))
        for tile, own, *changed in zip(measured, *played, strict=True):
            output = self._output(own)
            left = _filtered(tile, (tile.torque if self.of_torque else tile.state.position) - output)
            parts = zip(changed, self.changes, strict=True)
            columns = [_filtered(tile, (self._output(one) - output) / change) for one, change in parts]
            yield tile, list(self._equations(tile, np.stack(columns, axis=-1), left))

    def _output(self, played: Played) -> JointSeries:
        return played.torque if self.of_torque else played.state.position

    def _equations(self, tile: Tile, columns: np.ndarray, left: KeptSeries) -> Iterator[FilteredRows]:
        for joint, (own, rest) in enumerate(zip(columns, left, strict=True)):
            yield np.column_stack([own, rest + own @ self.base]), tile.usable[:, joint]


def _filtered(tile: Tile, series: JointSeries) -> KeptSeries:
    return tile.filtered(np.ascontiguousarray(series.T))
