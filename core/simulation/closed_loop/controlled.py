"""Simulate a log under the controller that the real robot had: it is given the logged references alone.

Whatever was measured drives nothing here, so that the motion holds none of its noise. It holds every error of
the controller instead: hence one is simulated only after it was found to recompute the log's command.
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import JointSeries
from ...signals.resample import linear
from ..control.control_law import ControlLaw, Inputs
from ..control.controller import LONGEST_DELAY, ControllerModel
from ..mechanism import Mechanism
from .simulated import Piece

_REFERENCES = ("position_ref", "velocity_ref", "torque_ref")
_BESIDE = 2 * LONGEST_DELAY
"""Samples on either side that a delayed and differentiated reference reaches."""


@dataclass(frozen=True, eq=False)
class Controlled:
    """Drive a robot by its own controller, which is given the references of the log."""

    controller: ControllerModel

    def law(self, step: float) -> ControlLaw:
        """Give the controller, which acts at the samples."""
        return self.controller.law(step)

    def of(self, mechanism: Mechanism) -> "Controlled":  # noqa: ARG002  (references alone drive it)
        """Give itself."""
        return self

    def inputs(self, piece: Piece) -> Inputs:
        """Give the references, late as the controller gets them."""
        begin, end = piece.first, piece.first + len(piece.torque)
        left, right = max(0, begin - _BESIDE), min(piece.segment.samples, end + _BESIDE)
        series = [_reference(piece, name, left, right) for name in _REFERENCES]
        position, velocity, torque = series
        whole = self.controller.inputs(piece.step, np.asarray(position), velocity, torque)
        inner = slice(begin - left, end - left)
        return Inputs(whole.feed_forward[inner], whole.position[inner], whole.velocity[inner])


def _reference(piece: Piece, name: str, begin: int, end: int) -> JointSeries | None:
    """Give a reference at samples of a segment's clock; None where it was not logged."""
    segment = piece.segment
    if segment.stamps is None:
        series: JointSeries | None = getattr(
            segment.log.source.rows(segment.start + begin, segment.start + end), name
        )
        return series
    grid = segment.begin_time + np.arange(begin, end) * piece.step
    low, high = np.searchsorted(segment.stamps, grid[[0, -1]])
    first, last = max(0, int(low) - 1), min(segment.samples, int(high) + 2)
    rows = segment.log.source.rows(segment.start + first, segment.start + last)
    values: JointSeries | None = getattr(rows, name)
    return None if values is None else linear(grid, rows.time, values)
