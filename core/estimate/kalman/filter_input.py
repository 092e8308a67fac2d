"""Give a Kalman filter the samples of fitted blocks, with their noise.

Positions are those that were measured, without any filter on them. Torque that cannot be used has noise as
large as itself.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...arrays import BaseParameters, BlockKey, JointSeries, SquareMatrix
from ...signals.condition import Motion
from ...signals.parallel import Tile
from ...signals.segment import Segment
from ...simulation.filter.state_filter import Clock, FilterState, StateFilter, filter_of
from ...simulation.integrate import steps_between
from .filter_start import FilterStart


@dataclass(frozen=True, eq=False)
class Stretch:
    """Hold samples of one block that a filter takes in at once."""

    key: BlockKey
    begins: bool
    """Whether nothing that was taken in comes right before them."""
    segment: Segment
    first: int
    """Number of the first sample in the segment."""
    tile: Tile
    samples: slice
    """Where they are in the tile."""
    kept: slice
    """The decimated samples among them."""

    @property
    def count(self) -> int:
        """Count the samples."""
        return int(self.samples.stop - self.samples.start)

    @property
    def position(self) -> JointSeries:
        """Give the measured positions."""
        return self.segment.measured_positions(self.first, self.first + self.count)

    def torque(self, own: StateFilter) -> JointSeries:
        """Give the torque; of a joint whose torque was not measured, the model's own."""
        torque, silent = self.tile.torque[self.samples], self.segment.unmeasured
        if not silent.any():
            return torque
        return np.where(silent, own.mechanism.torque(self.tile.state.at(self.samples)), torque)

    def noise(self, start: FilterStart, torque: JointSeries) -> JointSeries:
        """Give the torque's deviation, which filters make as small as what the first fit leaves.

        Where the torque is not usable, or was not measured, it is as large as the torque.
        """
        usable = np.repeat(self.tile.usable[self.kept], self.tile.parallel.decimation, axis=0)[: self.count]
        gain = np.sqrt(np.sum(self.tile.parallel.response**2))
        own = np.sqrt(np.mean(torque**2, axis=0))
        whole = np.where(self.segment.unmeasured, own, start.torque_rms)
        known = start.options.torque_noise * start.system.noise
        return np.asarray(np.where(usable, known, whole) / gain)

    def begun(self, own: StateFilter, known: BaseParameters, factor: SquareMatrix) -> FilterState:
        """Begin at the measured motion; its speed is known as two samples, or a standstill, tell it."""
        now = self.tile.state.at(slice(self.samples.start, self.samples.start + 1))
        step, still = own.clock.step, self.segment.recipe.still_speed
        before = now.velocity[0] - 0.5 * step / own.clock.substeps * now.acceleration[0]
        speed = np.hypot(np.sqrt(2.0 * own.variance) / step, still)
        return own.started(np.concatenate([known, now.position[0], before]), factor, speed)


def stretches(log: int, motion: Motion, held_out: frozenset[BlockKey]) -> Iterator[Stretch]:
    """Go through the fitted blocks of a motion."""
    segments, segment, begins = iter(motion.segments), motion.segments[0], True
    for tile in motion.tiles():
        if not tile.follows:
            segment, begins = next(segments), True
        step = tile.parallel.decimation
        number = round((float(tile.time[0]) - segment.begin_time) * segment.rate_hz)
        for block, kept in tile.parts():
            begin = tile.first + kept.start * step
            samples = slice(begin, min(tile.first + kept.stop * step, len(tile.torque)))
            if (log, block) not in held_out:
                yield Stretch((log, block), begins, segment, number + kept.start * step, tile, samples, kept)
            begins = (log, block) in held_out


def filter_of_segment(start: FilterStart, motion: Motion, segment: Segment) -> StateFilter:
    """Prepare the filter of a gap-free part of a motion."""
    step = 1.0 / segment.rate_hz
    clock = Clock(step, steps_between(step, start.substeps))
    known, held = start.variance(motion), motion.recipe.held
    return filter_of(start.base, start.standard, known, clock, held=held, unscented=start.unscented)
