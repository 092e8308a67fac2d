"""Condition a log: position, velocity, acceleration and torque on one clock, tile after tile.

The chain is the seed's: running median, zero-phase Butterworth on q, centred differences; the parallel filter
follows when the equations are written. What the filters reach of log ends and standstill is marked unusable,
because there the derivatives are guesses and friction is not sign(velocity). Source: the seed paper, section
4.1.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from scipy.signal import oaconvolve

from core.arrays import (
    InstantMask,
    Instants,
    InstantSeries,
    JointMask,
    JointSeries,
    KeptSeries,
    SampleMask,
    Samples,
    Series,
)
from core.errors import LogError
from core.log.model import JointLog, LogRows
from core.robot.model import RobotModel
from core.signals.derivative import centred_difference, median
from core.signals.parallel import ParallelFilter
from core.signals.recipe import FilterOptions, Recipe, choose_recipe
from core.signals.resample import dropped, is_uniform, on_grid
from core.signals.state import MotionState
from core.signals.zero_phase import kernel, reach_of

TILE_KEPT = 512
STILL_SECONDS = 0.2
END_SHARE = 1e-3
_NEIGHBOURS = 40
"""Samples on either side of a stretch that its spline is laid through; further ones change nothing."""
UNUSABLE_SHARE = 0.05
"""A kept instant is left out when more of the parallel filter's mass than this falls on unusable samples."""


@dataclass(frozen=True, eq=False)
class Tile:
    """Carry a stretch of motion at the log's rate, with the kept instants of the parallel filter inside it.

    Attributes
    ----------
    state
        Position, velocity, acceleration at the log's rate, the filter's reach included.
    torque
        Joint torque at the same instants, N m or N.
    first, time
        Sample at which the first kept instant lies, and the kept instants in s.
    usable
        Which kept instants may be used for which joint.
    block
        Number of the log's block that the tile belongs to.
    follows
        Whether its first kept instant comes right after the last one of the tile before, with no gap between.
    """

    state: MotionState
    torque: JointSeries
    parallel: ParallelFilter
    first: int
    time: Instants
    usable: InstantMask
    block: int
    follows: bool

    def filtered(self, series: Series) -> KeptSeries:
        """Apply the parallel filter to rows of samples and keep the tile's instants."""
        return self.parallel.apply(series, self.first, len(self.time))


@dataclass(frozen=True, eq=False)
class Motion:
    """Hold a log, its recipe and the factors that turn its effort channel into joint torque.

    Attributes
    ----------
    effort_scale
        Per joint: 1 for logged torque, torque constant times gear ratio for logged current.
    blocks
        Number of contiguous blocks the log is divided into for hold-out and bootstrap.
    """

    log: JointLog
    recipe: Recipe
    effort_scale: np.ndarray
    blocks: int
    segments: "tuple[_Segment, ...]" = field(repr=False)

    @cached_property
    def kept(self) -> int:
        """Count the kept instants of all segments."""
        return sum(segment.kept for segment in self.segments)

    def tiles(self) -> Iterator[Tile]:
        """Go through the motion once."""
        borders = [self.kept * number // self.blocks for number in range(self.blocks + 1)]
        done = 0
        for segment in self.segments:
            cuts = {0, segment.kept} | {
                border - done for border in borders if 0 < border - done < segment.kept
            }
            ordered = sorted(cuts)
            for begin, end in pairwise(ordered):
                block = int(np.searchsorted(borders, done + begin, side="right")) - 1
                for start in range(begin, end, TILE_KEPT):
                    yield segment.tile(self, start, min(start + TILE_KEPT, end), block)
            done += segment.kept


def condition(
    log: JointLog, robot: RobotModel, options: FilterOptions | None = None, *, blocks: int = 20
) -> Motion:
    """Settle clock, recipe and torque channel of a log for a robot.

    Raises
    ------
    LogError
        If the log has another number of joints than the robot, or currents without declared constants.
    """
    if log.joints != len(robot.joints):
        raise LogError(
            "the log and the robot have different numbers of joints",
            evidence={"log_joints": log.joints, "robot_joints": len(robot.joints), "log": log.name},
            remedy="map one position and one torque (or current) column to every joint of the robot",
        )
    recipe = choose_recipe(log, options or FilterOptions())
    segments = tuple(
        segment for segment in (_segment(log, recipe, *one) for one in log.segments) if segment is not None
    )
    if not segments:
        raise LogError(
            "no stretch of the log between its gaps is long enough to be differentiated",
            evidence={"longest_samples": max(stop - start for start, stop in log.segments), "log": log.name},
            remedy="record at least one second without gaps",
        )
    return Motion(log, recipe, _effort_scale(log, robot), blocks, segments)


@dataclass(frozen=True, eq=False)
class _Segment:
    """Give conditioned stretches of one gap-free part of a log."""

    log: JointLog
    recipe: Recipe
    start: int
    begin_time: float
    rate_hz: float
    samples: int
    stamps: Samples | None

    @cached_property
    def kept(self) -> int:
        return (self.samples - 1) // self.recipe.decimation + 1

    @cached_property
    def parallel(self) -> ParallelFilter:
        return ParallelFilter(
            kernel(self.recipe.cutoff_hz, self.rate_hz, self.recipe.order), self.recipe.decimation
        )

    @property
    def still_samples(self) -> int:
        return max(3, int(STILL_SECONDS * self.rate_hz))

    @cached_property
    def low_pass(self) -> Samples:
        return kernel(self.recipe.position_cutoff_hz, self.rate_hz, self.recipe.order)

    def tile(self, motion: Motion, first_kept: int, last_kept: int, block: int) -> Tile:
        step, reach = self.recipe.decimation, self.parallel.reach
        first, last = first_kept * step, (last_kept - 1) * step
        begin, end = max(0, first - reach), min(self.samples, last + reach + 1)
        # A standstill is known by its length, so the look for it reaches that much further than the filter.
        early, late = max(0, begin - self.still_samples), min(self.samples, end + self.still_samples)
        wide, torque = self._conditioned(early, late)
        inner = slice(begin - early, end - early)
        state = MotionState(wide.position[inner], wide.velocity[inner], wide.acceleration[inner])
        marks = self._unusable(wide.velocity, early)[inner]
        influence = self.parallel.influence(marks.T.astype(float), first - begin, last_kept - first_kept)
        return Tile(
            state=state,
            torque=torque[inner] * motion.effort_scale,
            parallel=self.parallel,
            first=first - begin,
            time=self.begin_time + np.arange(first_kept, last_kept) * (step / self.rate_hz),
            usable=influence.T <= UNUSABLE_SHARE,
            block=block,
            follows=first_kept > 0,
        )

    def _conditioned(self, begin: int, end: int) -> tuple[MotionState, JointSeries]:
        halo = self.recipe.median_order // 2 + len(self.low_pass) // 2 + 2
        left, right = max(0, begin - halo), min(self.samples, end + halo)
        position, torque = self._read(left, right)
        padded = _extend(position, halo - (begin - left), halo - (right - end))
        smooth = oaconvolve(
            median(padded, self.recipe.median_order), self.low_pass[:, None], mode="valid", axes=0
        )
        velocity = centred_difference(smooth, self.rate_hz)
        acceleration = centred_difference(velocity, self.rate_hz)
        state = MotionState(smooth[2:-2], velocity[1:-1], acceleration)
        return state, torque[begin - left : len(torque) - (right - end)]

    def _read(self, begin: int, end: int) -> tuple[JointSeries, JointSeries]:
        if self.stamps is None:
            return self._read_even(begin, end)
        grid = self.begin_time + np.arange(begin, end) / self.rate_hz
        near = np.searchsorted(self.stamps, grid[[0, -1]])
        low, high = max(0, int(near[0]) - _NEIGHBOURS), min(len(self.stamps), int(near[1]) + _NEIGHBOURS)
        rows = self.log.source.rows(self.start + low, self.start + high)
        return on_grid(rows, _effort(rows), grid)

    def _read_even(self, begin: int, end: int) -> tuple[JointSeries, JointSeries]:
        """Take even samples as they are, unless some of them only repeat the one before."""
        low, high = max(0, begin - _NEIGHBOURS), min(self.samples, end + _NEIGHBOURS)
        rows = self.log.source.rows(self.start + low, self.start + high)
        inner = slice(begin - low, end - low)
        if not dropped(rows).any():
            return rows.position[inner], _effort(rows)[inner]
        return on_grid(rows, _effort(rows), rows.time[inner])

    def _unusable(self, velocity: JointSeries, begin: int) -> JointMask:
        reach = reach_of(self.low_pass, END_SHARE) + self.recipe.median_order // 2 + 2
        index = np.arange(begin, begin + len(velocity))
        ends: SampleMask = (index < reach) | (index >= self.samples - reach)
        slow = np.abs(velocity) <= self.recipe.still_speed
        return np.asarray(ends[:, None] | _long_runs(slow, self.still_samples))


def _long_runs(mask: JointMask, run: int) -> JointMask:
    """Keep the stretches of a mask that last at least `run` samples: those that some full window covers."""
    if len(mask) < run:
        return np.asarray(mask & mask.all(axis=0))
    full = _window_sums(mask, run) == run
    return np.asarray(_window_sums(np.pad(full, ((run - 1, run - 1), (0, 0))), run) > 0)


def _window_sums(mask: JointMask, run: int) -> np.ndarray:
    """Count the marks in every window of `run` samples."""
    sums = np.cumsum(np.pad(mask, ((1, 0), (0, 0))), axis=0)
    return np.asarray(sums[run:] - sums[:-run])


def _segment(log: JointLog, recipe: Recipe, start: int, stop: int) -> _Segment | None:
    stamps = np.concatenate(
        [log.source.rows(row, min(row + 65536, stop)).time for row in range(start, stop, 65536)]
    )
    if stop - start < 16 or stamps[-1] - stamps[0] < 1.0:
        return None
    rate = (len(stamps) - 1) / (stamps[-1] - stamps[0])
    even = is_uniform(stamps, float(rate))
    return _Segment(log, recipe, start, float(stamps[0]), float(rate), len(stamps), None if even else stamps)


def _effort(rows: LogRows) -> JointSeries:
    effort = rows.torque if rows.torque is not None else rows.current
    return np.zeros_like(rows.position) if effort is None else effort


def _effort_scale(log: JointLog, robot: RobotModel) -> np.ndarray:
    if "torque" in log.channels:
        return np.ones(len(robot.joints))
    undeclared = [
        joint.name for joint in robot.joints if joint.torque_constant is None or joint.gear_ratio is None
    ]
    if undeclared:
        raise LogError(
            "the log holds currents, and the robot does not say what torque a current gives",
            evidence={"joints": undeclared, "log": log.name},
            remedy="declare torque_constant (N m/A) and gear_ratio of these joints, or log joint torque",
        )
    return np.array(
        [float(joint.torque_constant or 0.0) * float(joint.gear_ratio or 0.0) for joint in robot.joints]
    )


def _extend(position: JointSeries, before: int, after: int) -> InstantSeries:
    """Continue a series beyond its ends by turning it about its end points, as far as it is long enough."""
    pads = ((min(before, len(position) - 1), min(after, len(position) - 1)), (0, 0))
    turned = np.pad(position, pads, mode="reflect", reflect_type="odd")
    missing = ((before - pads[0][0], after - pads[0][1]), (0, 0))
    return np.pad(turned, missing, mode="edge")


def without_standstill_mask(motion: Motion) -> Motion:
    """Give the same motion with standing samples counted as usable.

    For causes whose evidence lies at standstill.
    """
    recipe = replace(motion.recipe, still_speed=np.full_like(motion.recipe.still_speed, -1.0))
    segments = tuple(replace(segment, recipe=recipe) for segment in motion.segments)
    return replace(motion, recipe=recipe, segments=segments)
