"""Condense conditioned motions to some hundred instants that a set-up can be tried on in milliseconds."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import BlockKey, InstantSeries, JointMask, JointSeries, SampleMask
from ..log.columns.assignment import Assignment
from ..signals.condition import Motion
from ..signals.parallel import Tile
from ..signals.state import MotionState
from .thresholds import TRIAL


@dataclass(frozen=True, eq=False)
class Samples:
    """Hold some instants of all motions, filtered alike."""

    position: JointSeries
    velocity: JointSeries
    acceleration: JointSeries
    torque: JointSeries
    """In rad or m, per s, per s2, N m or N."""
    direction: JointSeries
    """Sign of the velocity, filtered: the sign of a filtered velocity is another thing."""
    usable: JointMask
    judged: SampleMask
    """Rows that no trial is fitted to."""
    independent: float
    """Number of independent values of a joint among the rows that are judged: what a model leaves varies as
    the motion does, twice its band per second."""

    def moved(self, assignment: Assignment) -> "Samples":
        """Read the motion as an assignment does; torques stay as measured."""
        position = assignment.position
        speed = 1.0 / assignment.time_factor
        return replace(
            self,
            position=position.of(self.position),
            velocity=position.of(self.velocity, rate=True) * speed,
            acceleration=position.of(self.acceleration, rate=True) * speed**2,
            direction=np.sign(position.factor) * self.direction[:, list(position.source)],
            usable=self.usable[:, list(position.source)],
        )

    def at(self, wanted: SampleMask) -> "Samples":
        """Keep some of the instants."""
        series = "position", "velocity", "acceleration", "torque", "direction", "usable", "judged"
        return replace(self, **{name: getattr(self, name)[wanted] for name in series})

    @property
    def state(self) -> MotionState:
        """Give the motion as terms of a model take it."""
        return MotionState(self.position, self.velocity, self.acceleration, np.zeros(len(self.position)))


def _tiles(motions: tuple[Motion, ...], held_out: frozenset[BlockKey]) -> Iterator[tuple[Tile, bool]]:
    """Give the tiles that are not held out, and whether each judges."""
    for number, motion in enumerate(motions):
        fitted = {block for block in range(motion.blocks) if (number, block) not in held_out}
        for tile in motion.tiles(fitted):
            yield tile, _is_judged(tile.block, number, held_out)


def sampled(motions: tuple[Motion, ...], held_out: frozenset[BlockKey]) -> Samples:
    """Take every n-th decimated sample of the blocks that are not held out."""
    stride = max(1, -(-sum(motion.kept for motion in motions) // TRIAL.rows))
    tiles = list(_tiles(motions, held_out))

    def gathered(series: Callable[[Tile], InstantSeries]) -> InstantSeries:
        return np.concatenate([series(tile)[::stride] for tile, _ in tiles])

    judged = np.concatenate([np.full(-(-len(tile.time) // stride), judges) for tile, judges in tiles])
    cycles = sum(motion.log.duration * motion.recipe.motion_band_hz for motion in motions)
    return Samples(
        position=gathered(lambda tile: _filtered(tile, tile.state.position)),
        velocity=gathered(lambda tile: _filtered(tile, tile.state.velocity)),
        acceleration=gathered(lambda tile: _filtered(tile, tile.state.acceleration)),
        torque=gathered(lambda tile: _filtered(tile, tile.torque)),
        direction=gathered(lambda tile: _filtered(tile, np.sign(tile.state.velocity))),
        usable=np.concatenate([tile.usable[::stride] for tile, _ in tiles]),
        judged=judged,
        independent=max(1.0, float(judged.mean() * 2.0 * cycles)),
    )


def _filtered(tile: Tile, series: JointSeries) -> InstantSeries:
    return tile.filtered(np.ascontiguousarray(series.T)).T


def _is_judged(block: int, number: int, held_out: frozenset[BlockKey]) -> bool:
    """Tell whether a block judges: every third of those of a log that are fitted."""
    before = sum((number, other) not in held_out for other in range(block))
    return before % TRIAL.judged_every == 1
