"""Replay a log tile by tile: the motion that a robot makes under the torque that was measured.

The measured torque drives the simulated robot, and a soft controller pulls it to the measured motion; what it
adds is what the model lacks. So no controller has to be known. The columns of the motion that comes out hold
little of the measured motion's noise, which the controller damps, and friction at rest is what holds there.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Samples
from ..signals.condition import Motion
from ..signals.parallel import Tile
from ..signals.state import MotionState, concatenate_states
from .gains import Gains, default_gains
from .integrate import LONGEST_STEP
from .loop import ControlLaw, Inputs, Loop, LoopState
from .mechanism import Mechanism

_POSITIONS_PER_TILE = 16
"""Positions that tell the inertia which a joint sees on its way."""


@dataclass(frozen=True, eq=False)
class Replay:
    """Give the tiles of a motion with what the robot does in the place of what was measured."""

    motion: Motion
    mechanism: Mechanism
    gains: Gains
    substeps: int | None = None
    """Steps of the simulation per sample; None for steps of `LONGEST_STEP` at most."""

    @property
    def kept(self) -> int:
        """Count the decimated samples."""
        return self.motion.kept

    def tiles(self) -> Iterator[Tile]:
        """Go once through the motion; every gap-free part of it begins as it was measured.

        Raises
        ------
        OptionError
            If the model has terms that the loop does not simulate.
        SolverError
            If the simulated motion diverges.
        """
        lane: _Lane | None = None
        for tile in self.motion.tiles():
            lane = self._begun(tile) if lane is None or not tile.follows else lane.onwards(tile)
            yield replace(tile, state=replace(lane.seen, temperature=tile.state.temperature))

    def _begun(self, tile: Tile) -> "_Lane":
        time = _clock(tile.state)
        step = float(time[-1] - time[0]) / (len(time) - 1)
        substeps = self.substeps or max(1, int(np.ceil(step / LONGEST_STEP - 1e-9)))
        loop = Loop(self.mechanism, ControlLaw.of_joints(self.gains), step, substeps)
        return _Lane(loop, loop.start(tile.state), tile.state.at(slice(0))).onwards(tile)


@dataclass(frozen=True, eq=False)
class _Lane:
    """Hold the simulation of a gap-free part: where it stands, and what the last tile saw of it."""

    loop: Loop
    state: LoopState
    seen: MotionState

    def onwards(self, tile: Tile) -> "_Lane":
        """Simulate up to the tile's last sample; the first ones it shares with the tile before."""
        time = _clock(self.seen)
        known = int(np.count_nonzero(time > _clock(tile.state)[0] - 0.5 * self.loop.step))
        fresh = slice(known, None)
        measured = tile.state.at(fresh)
        inputs = Inputs(tile.torque[fresh], measured.position, measured.velocity)
        played, state = self.loop.run(self.state, inputs)
        if not known:
            return _Lane(self.loop, state, played.state)
        before = self.seen.at(slice(len(time) - known, None))
        return _Lane(self.loop, state, concatenate_states([before, played.state]))


def _clock(state: MotionState) -> Samples:
    """Give the instants of conditioned or simulated motion, which are always known."""
    return np.asarray(state.time)


def replay(
    mechanism: Mechanism, motions: tuple[Motion, ...], bandwidth_hz: float, substeps: int | None = None
) -> tuple[Replay, ...]:
    """Replay motions with a controller of this bandwidth (Hz), the same for all."""
    positions = [
        tile.state.position[:: 1 + len(tile.torque) // _POSITIONS_PER_TILE]
        for motion in motions
        for tile in motion.tiles()
    ]
    gains = default_gains(mechanism, np.vstack(positions), bandwidth_hz)
    return tuple(Replay(motion, mechanism, gains, substeps) for motion in motions)
