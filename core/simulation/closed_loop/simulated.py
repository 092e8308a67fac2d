"""Simulate a log's motion tile by tile: what a robot does in the place of what was measured.

What drives it along the log is a source of its own: a replay of the measured torque, or the controller that
the real robot had. Every gap-free part begins as it was measured and is simulated in one go.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from itertools import tee
from typing import Protocol, runtime_checkable

import numpy as np

from ...arrays import JointSeries, Matrix, Samples
from ...signals.condition import Motion
from ...signals.parallel import Tile
from ...signals.segment import Segment
from ...signals.state import MotionState
from ..control.control_law import ControlLaw, Inputs
from ..integrate import steps_between
from ..mechanism import Mechanism
from .flexible_loop import FlexibleLoop
from .loop import Loop, LoopState, Played


@dataclass(frozen=True, eq=False)
class Piece:
    """Hold the measured samples that are simulated next."""

    segment: Segment
    step: float
    """Time between samples, s."""
    first: int
    """Number of the first of them in the segment."""
    state: MotionState
    torque: JointSeries


@runtime_checkable
class Source(Protocol):
    """Drive a simulated robot along a log."""

    def law(self, step: float) -> ControlLaw:
        """Give the controller at samples that are so far apart, s."""

    def of(self, mechanism: Mechanism) -> "Source":
        """Give the source that drives another robot."""

    def inputs(self, piece: Piece) -> Inputs:
        """Give what the controller is given at the samples of a piece."""


@dataclass(frozen=True, eq=False)
class SimulatedMotion:
    """Give the tiles of a motion with what the robot does in the place of what was measured."""

    motion: Motion
    mechanism: Mechanism
    source: Source
    substeps: int | None = None
    """Steps of the simulation per sample; None for steps of `LONGEST_STEP` at most."""
    slopes: dict[float, Matrix] = field(default_factory=dict)
    """Derivatives by which flexible joints begin, by the instant of the beginning; robots that are made of
    this one by `of` share them, as they differ by little."""

    @property
    def kept(self) -> int:
        """Count the decimated samples."""
        return self.motion.kept

    def tiles(self) -> Iterator[Tile]:
        """Go once through the motion.

        Raises
        ------
        OptionError
            If the model has terms that the loop does not simulate.
        SolverError
            If the simulated motion diverges.
        """
        measured, followed = tee(self.motion.tiles())
        for tile, played in zip(measured, self.along(followed), strict=True):
            state = replace(played.state, temperature=tile.state.temperature, log=tile.state.log)
            yield replace(tile, state=state)

    def of(self, mechanism: Mechanism) -> "SimulatedMotion":
        """Give the motion of another robot, driven by the same source."""
        return replace(self, mechanism=mechanism, source=self.source.of(mechanism))

    def along(self, tiles: Iterable[Tile]) -> Iterator[Played]:
        """Simulate what the tiles of the motion see, one after another."""
        segments = iter(self.motion.segments)
        lane: _Lane | None = None
        for tile in tiles:
            lane = (
                self._begun(next(segments), tile) if lane is None or not tile.follows else lane.onwards(tile)
            )
            yield lane.seen

    def _begun(self, segment: Segment, tile: Tile) -> "_Lane":
        step = 1.0 / segment.rate_hz
        mechanism = self.mechanism.holding(self.motion.recipe.held)
        steps, none = steps_between(step, self.substeps), Played(tile.state.at(slice(0)), tile.torque[:0])
        if mechanism.springs is None:
            loop = Loop(mechanism, self.source.law(step), step, steps)
            return _Lane(segment, self.source, loop, loop.start(tile.state), none).onwards(tile)
        flexible = FlexibleLoop(mechanism, self.source.law(step), step, steps)
        inputs = self.source.inputs(Piece(segment, step, 0, tile.state, tile.torque))
        known = self.slopes.get(segment.begin_time)
        begun, self.slopes[segment.begin_time] = flexible.start(tile.state, inputs, known)
        return _Lane(segment, self.source, flexible, begun, none).onwards(tile)


@dataclass(frozen=True, eq=False)
class _Lane:
    """Hold the simulation of a gap-free part: where it stands, and what the last tile saw of it."""

    segment: Segment
    source: Source
    loop: Loop | FlexibleLoop
    state: LoopState
    seen: Played

    def onwards(self, tile: Tile) -> "_Lane":
        """Simulate up to the tile's last sample; the first ones it shares with the tile before."""
        begin, step, time = _clock(tile.state)[0], self.loop.step, _clock(self.seen.state)
        known = int(np.count_nonzero(time > begin - 0.5 * step))
        first = known + round(float(begin - self.segment.begin_time) / step)
        fresh = slice(known, None)
        piece = Piece(self.segment, step, first, tile.state.at(fresh), tile.torque[fresh])
        played, state = self.loop.run(self.state, self.source.inputs(piece))
        return replace(self, state=state, seen=self.seen.at(slice(len(time) - known, None)).then(played))


def _clock(state: MotionState) -> Samples:
    """Give the instants of conditioned or simulated motion, which are always known."""
    return np.asarray(state.time)
