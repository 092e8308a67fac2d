"""Condition one gap-free part of a log, any stretch of it by itself, by the seed's chain.

Running median of absurd samples, zero-phase Butterworth on q, differences of seven samples; what these reach
of the ends and of rows that are missing for long, and every standstill, is marked unusable. Source: the seed
paper, section 4.1.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..arrays import (
    Indices,
    Instants,
    InstantSeries,
    JointMask,
    JointSeries,
    JointVector,
    Matrix,
    SampleMask,
    Samples,
)
from ..log.defects.clock import GAP_STEPS, longest_bridge
from ..log.model import JointLog, LogRows
from ..numerics.filtering import convolved, running_maximum
from .clock import ROWS, is_even
from .derivative import REACH, absurd_reach, differentiate
from .marks import at_limit, changes_sign, long_runs
from .parallel import ParallelFilter, Tile
from .recipe import Recipe, is_usable
from .resample import (
    Readings,
    beside,
    dropped_mask,
    efforts_on,
    gap_mask,
    linear,
    plausible_effort,
    positions_on,
    without_spikes,
)
from .state import MotionState
from .zero_phase import kernel, modes, reach_of

STILL_SECONDS = 0.2
END_SHARE = 1e-3
_NEIGHBOURS = 40
"""Samples on either side of a stretch that its spline is laid through; further ones change nothing."""
EFFORT_SPIKES = (("outliers", "torque"), ("outliers", "current"))
UNUSABLE_SHARE = 0.05
"""A decimated sample is left out when more of the parallel filter's weight falls on unusable samples."""
REVERSAL_SHARE = 0.03
"""A decimated sample lies beside a reversal when more of the parallel filter's weight falls on its instants.

Such a sample's friction errs by up to twice that share of Coulomb's level, alike at all reversals: a bias. A
smaller share leaves fewer rows to tell the parameters. Source: the estimators' bench, a TX40 with noise of
1e-3 deg and 0.05 N m, and of 1e-2 deg and 0.5 N m. Errors of torque over 50 logs each: 0.090 and 0.23 % with
5 %, 0.055 and 0.23 % with 3 %; over six logs with 2 %: 0.053 and 0.25 %.
"""


@dataclass(frozen=True, eq=False)
class Segment:
    """Give conditioned stretches of one gap-free part of a log."""

    log: JointLog
    recipe: Recipe
    start: int
    """Its first row in the log."""
    begin_time: float
    rate_hz: float
    samples: int
    """Its uniform clock: first instant in s, mean rate, number of instants."""
    stamps: Samples | None
    """The real stamps in s where they deviate from that clock, else None."""
    motors: Matrix
    """Weights of the joints' speeds in those of motors that move several joints, motors x joints."""
    number: int = 0
    """Number of its log among those that are studied together."""

    @cached_property
    def kept(self) -> int:
        """Count the decimated samples."""
        return (self.samples - 1) // self.recipe.decimation + 1

    @cached_property
    def parallel(self) -> ParallelFilter:
        """Give the parallel filter at this part's rate."""
        design = self.recipe.cutoff_hz, self.rate_hz, self.recipe.order
        return ParallelFilter(kernel(*design), modes(*design), self.recipe.decimation)

    @property
    def still_samples(self) -> int:
        """Count the samples that a joint must be slow for to stand."""
        return max(3, int(STILL_SECONDS * self.rate_hz))

    @cached_property
    def low_pass(self) -> Samples:
        """Give the kernel of the filter on q."""
        return kernel(self.recipe.position_cutoff_hz, self.rate_hz, self.recipe.order)

    @cached_property
    def reach(self) -> int:
        """Count the samples on either side that bear on a conditioned one."""
        return reach_of(self.low_pass, END_SHARE) + absurd_reach(self.recipe.median_order) + 2 * REACH

    @property
    def direction_samples(self) -> int:
        """Count the samples on either side up to which the filter on q blurs when a joint turns round."""
        return int(np.ceil(self.rate_hz / self.recipe.position_cutoff_hz))

    def tile(
        self, effort_scale: JointVector, kept: slice, block: Indices | None = None, *, follows: bool = False
    ) -> Tile:
        """Condition the stretch that some decimated samples need; all are of one block by default."""
        step = self.recipe.decimation
        first, (begin, end) = kept.start * step, self._seen(kept.start, kept.stop)
        # A standstill is known by its length, so the search for it reaches that much further than the filter.
        halo = max(self.still_samples, self.direction_samples + 1)
        early, late = max(0, begin - halo), min(self.samples, end + halo)
        wide, torque, unknown = self._condition(early, late)
        inner = slice(begin - early, end - early)
        now = self.begin_time + np.arange(begin, end) / self.rate_hz
        logs = np.full(len(now), float(self.number))
        state = replace(wide.at(inner), time=now, temperature=self._temperature(now), log=logs)
        marks = (self._unusable(wide.velocity, early) | self._at_a_limit(torque) | unknown[:, None])[inner]
        turns = self._undirected(wide.velocity)[inner]
        unusable, turning = (
            share < self.parallel.influence(mask.T.astype(float), first - begin, kept.stop - kept.start).T
            for mask, share in ((marks, UNUSABLE_SHARE), (turns, REVERSAL_SHARE))
        )
        return Tile(
            state=state,
            torque=torque[inner] * effort_scale,
            parallel=self.parallel,
            first=first - begin,
            time=self.begin_time + np.arange(kept.start, kept.stop) * (step / self.rate_hz),
            usable=~unusable,
            turning=turning & ~unusable,
            block=np.zeros(kept.stop - kept.start, dtype=int) if block is None else block,
            follows=follows,
        )

    def measured_positions(self, begin: int, end: int) -> JointSeries:
        """Give the positions (rad or m) of some samples without spikes, but not filtered."""
        return self._read(begin, end).position

    def effort(self, first_kept: int, last_kept: int) -> tuple[JointSeries, int]:
        """Give the effort that such decimated samples see, and the sample at which the first of them lies."""
        begin, end = self._seen(first_kept, last_kept)
        return self._read(begin, end).effort, first_kept * self.recipe.decimation - begin

    def _seen(self, first_kept: int, last_kept: int) -> tuple[int, int]:
        """Give the samples that decimated samples see, from the first up to, not including, the last."""
        step, reach = self.recipe.decimation, self.parallel.reach
        return max(0, first_kept * step - reach), min(self.samples, (last_kept - 1) * step + reach + 1)

    def _condition(self, begin: int, end: int) -> tuple[MotionState, JointSeries, SampleMask]:
        """Give state, torque, and what rests on instants at which nothing was measured."""
        halo = len(self.low_pass) // 2 + 2 * REACH
        left, right = max(0, begin - halo), min(self.samples, end + halo)
        read = self._read(left, right)
        padded = _extend(read.position, halo - (begin - left), halo - (right - end))
        smooth = convolved(padded, self.low_pass)
        velocity = differentiate(smooth, self.rate_hz)
        acceleration = differentiate(velocity, self.rate_hz)
        still = self.recipe.held & (np.abs(velocity) <= self.recipe.still_speed)
        velocity[still] = 0.0
        acceleration[still[REACH:-REACH]] = 0.0
        state = MotionState(smooth[2 * REACH : -2 * REACH], velocity[REACH:-REACH], acceleration)
        if read.stamps is not None:
            grid = self.begin_time + np.arange(begin, end) / self.rate_hz
            stamped, behind = beside(grid, read.stamps, state.velocity)
            state = replace(state, stamped_velocity=stamped, behind=behind)
        inner = slice(begin - left, len(read.effort) - (right - end))
        gap = read.unknown
        unknown = running_maximum(gap, self.reach) if gap.any() else gap
        return state, read.effort[inner], unknown[inner]

    def _read(self, begin: int, end: int) -> Readings:
        if self.stamps is None:
            return self._read_even(begin, end)
        grid = self.begin_time + np.arange(begin, end) / self.rate_hz
        near = np.searchsorted(self.stamps, grid[[0, -1]])
        rows, _ = self._rows(int(near[0]), int(near[1]))
        return self._interpolate(rows, grid)

    def _read_even(self, begin: int, end: int) -> Readings:
        """Take even samples as they are, unless some of them only repeat the one before."""
        rows, before = self._rows(begin, end)
        inner = slice(before, before + end - begin)
        if dropped_mask(rows).any():
            return self._interpolate(rows, rows.time[inner])
        position = without_spikes(rows.position, self.recipe.median_order)
        effort = plausible_effort(rows, self._effort_limits)
        return Readings(position[inner], effort[inner], np.zeros(end - begin, dtype=bool), None)

    def _rows(self, begin: int, end: int) -> tuple[LogRows, int]:
        """Read some rows with all neighbours that bear on them; count those before them."""
        neighbours = _NEIGHBOURS + absurd_reach(self.recipe.median_order)
        low, high = max(0, begin - neighbours), min(self.samples, end + neighbours)
        return self.log.source.rows(self.start + low, self.start + high), begin - low

    def _interpolate(self, rows: LogRows, grid: Instants) -> Readings:
        """Interpolate at the instants of a grid; copied rows count as a gap in the stamps."""
        bridge = longest_bridge(1.0 / self.rate_hz, self.recipe.motion_band_hz)
        unknown = gap_mask(rows, grid, max(bridge, GAP_STEPS / self.rate_hz))
        position = positions_on(grid, rows, self.recipe.median_order)
        effort = efforts_on(grid, rows, self._effort_limits)
        return Readings(position, effort, unknown, rows.time[~dropped_mask(rows)])

    def _temperature(self, now: Instants) -> InstantSeries | None:
        if "temperature" not in self.log.channels:
            return None
        if self.stamps is None:
            low, high = np.rint((now[[0, -1]] - self.begin_time) * self.rate_hz).astype(int)
        else:
            low, high = np.searchsorted(self.stamps, now[[0, -1]])
        first, last = max(0, int(low) - 1), min(self.samples, int(high) + 2)
        rows = self.log.source.rows(self.start + first, self.start + last)
        if rows.temperature is None:
            return None
        return linear(now, rows.time, rows.temperature)

    def _unusable(self, velocity: JointSeries, begin: int) -> JointMask:
        index = np.arange(begin, begin + len(velocity))
        ends: SampleMask = (index < self.reach) | (index >= self.samples - self.reach)
        slow = np.abs(velocity) <= self.recipe.still_speed
        return np.asarray(ends[:, None] | long_runs(slow, self.still_samples) | self.unmeasured)

    def _at_a_limit(self, effort: JointSeries) -> JointMask:
        """Mark the efforts at the limit of a channel that saturates: the true ones may lie beyond."""
        marks = np.zeros(effort.shape, dtype=bool)
        for defect in self.log.defects:
            if defect.kind == "saturation" and defect.level is not None and defect.joint is not None:
                marks[:, defect.joint - 1] |= at_limit(effort[:, defect.joint - 1], defect.level)
        return marks

    def _undirected(self, velocity: JointSeries) -> JointMask:
        """Mark the samples at which it is not known which way a joint moves, nor so its friction.

        It is known where the speed has one sign over a period of the cut-off of the filter on q, before and
        after.
        """
        still = self.recipe.still_speed
        marks = changes_sign(velocity, still)
        if len(self.motors):
            own = changes_sign(velocity @ self.motors.T, np.sqrt(self.motors**2 @ still**2))
            marks |= (own.astype(float) @ (self.motors != 0.0)) > 0.0
        return running_maximum(marks, self.direction_samples)

    @cached_property
    def _effort_limits(self) -> JointVector:
        """Give, per joint, how far from the median of its neighbours an effort is a spike."""
        limits = np.full(self.log.joints, np.inf)
        for defect in self.log.defects:
            if (defect.kind, defect.channel) in EFFORT_SPIKES and defect.joint is not None:
                limits[defect.joint - 1] = defect.level
        return limits

    @cached_property
    def unmeasured(self) -> np.ndarray:
        """Mark the joints whose torque was not measured, though other joints' was."""
        silent = np.zeros(self.log.joints, dtype=bool)
        for defect in self.log.defects:
            if defect.kind == "missing_torque" and defect.joint is not None:
                silent[defect.joint - 1] = True
        return silent


def gap_free(
    log: JointLog, recipe: Recipe, span: tuple[int, int], motors: Matrix | None = None
) -> Segment | None:
    """Check the stamps of some rows; None where they are too few or too slow to be differentiated.

    `motors` are the weights of motors that move several joints; none by default.
    """
    start, stop = span
    stamps = np.concatenate(
        [log.source.rows(row, min(row + ROWS, stop)).time for row in range(start, stop, ROWS)]
    )
    if not is_usable(stop - start, float(stamps[-1] - stamps[0]), log.rate_hz):
        return None
    rate = (len(stamps) - 1) / (stamps[-1] - stamps[0])
    position = without_spikes(log.source.rows(start, min(start + ROWS, stop)).position, recipe.median_order)
    even = is_even(stamps, position, float(rate))
    shared = np.zeros((0, log.joints)) if motors is None else motors
    return Segment(
        log, recipe, start, float(stamps[0]), float(rate), len(stamps), None if even else stamps, shared
    )


def _extend(position: JointSeries, before: int, after: int) -> InstantSeries:
    """Continue a series beyond its ends by turning it about its end points, as far as it is long enough."""
    pads = ((min(before, len(position) - 1), min(after, len(position) - 1)), (0, 0))
    turned = np.pad(position, pads, mode="reflect", reflect_type="odd")
    missing = ((before - pads[0][0], after - pads[0][1]), (0, 0))
    return np.pad(turned, missing, mode="edge")
