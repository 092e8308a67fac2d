"""Cut measured motion into windows that start at decimated samples and end within the same block of the log.

A window never crosses a gap, the border of a block, or what the filters spoil at a log's ends; standing
joints stay in, because a simulation has to get standstill right too.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from ..arrays import BlockKey, JointSeries, Samples
from ..errors import LogError
from ..signals.condition import Motion, without_standstill_mask
from ..signals.parallel import Tile
from ..signals.state import MotionState, concatenate_states


@dataclass(frozen=True, eq=False)
class Stretch:
    """Hold unbroken measured motion within one block of one log, at the log's rate."""

    key: BlockKey
    """Log and block number, from 0."""
    step: float
    """Time between samples, s."""
    every: int
    """Samples between two decimated samples; the first sample is one."""
    time: Samples
    state: MotionState
    torque: JointSeries
    around: MotionState
    inside: slice
    """The motion together with what the filters reached on either side, and where in it the stretch lies."""


@dataclass(frozen=True, eq=False)
class Windows:
    """Hold windows of equal length side by side, (instants, joints, windows), all of one clock."""

    step: float
    """Time between instants, s."""
    begins: Samples
    """Where each window begins, s."""
    keys: tuple[BlockKey, ...]
    """Log and block of each window."""
    start: MotionState
    """The measured state each window begins with, one row per window."""
    position: np.ndarray
    velocity: np.ndarray
    torque: np.ndarray


DrivenBy = Callable[[Stretch], JointSeries]
"""Give the torque (N m or N) that is to drive a stretch, sample by sample."""


def stretches(motions: tuple[Motion, ...], chosen: frozenset[BlockKey] | None = None) -> Iterator[Stretch]:
    """Go through the motions block by block (all blocks by default)."""
    for log, motion in enumerate(motions):
        blocks = None if chosen is None else {block for number, block in chosen if number == log}
        for block, run in _runs(without_standstill_mask(motion).tiles(blocks)):
            yield from _usable_part((log, block), run)


def _runs(tiles: Iterable[Tile]) -> Iterator[tuple[int, list[Tile]]]:
    """Gather the parts of tiles that follow each other within a block."""
    run: list[Tile] = []
    within = -1
    for block, part in (pair for tile in tiles for pair in tile.by_block()):
        if run and not (part.follows and block == within):
            yield within, run
            run = []
        run.append(part)
        within = block
    if run:
        yield within, run


def measured_torque(stretch: Stretch) -> JointSeries:
    """Give the torque that was measured."""
    return stretch.torque


def windows(
    motions: tuple[Motion, ...],
    seconds: float,
    every: float,
    chosen: frozenset[BlockKey] | None = None,
    *,
    drive: DrivenBy = measured_torque,
) -> Iterator[Windows]:
    """Cut windows of a length, one every so many seconds; those of one clock come together.

    Parameters
    ----------
    drive
        Which torque of a stretch the windows are to hold.

    Raises
    ------
    LogError
        If no chosen block is as long as a window.
    """
    pile: list[Windows] = []
    longest, found = 0.0, False
    for stretch in stretches(motions, chosen):
        longest = max(longest, stretch.step * (len(stretch.time) - 1))
        cut = _cut_windows(stretch, seconds, every, drive)
        if cut is None:
            continue
        found = True
        if pile and not same_clock(pile[-1].step, cut.step):
            yield _join_windows(pile)
            pile = []
        pile.append(cut)
    if not found:
        raise LogError(
            "no block of the log is as long as a simulated window",
            evidence={"window_seconds": seconds, "longest_seconds": longest},
            remedy="simulate shorter windows, divide the log into fewer blocks, or record a longer log",
        )
    yield _join_windows(pile)


def same_clock(one: float, other: float) -> bool:
    """Tell whether two steps (s) differ by rounding only."""
    return abs(one - other) <= 1e-6 * one


def _usable_part(key: BlockKey, run: list[Tile]) -> Iterator[Stretch]:
    """Give the stretch from the first usable instant of a run to the last one; nothing where none is."""
    every = run[0].parallel.decimation
    usable = np.concatenate([tile.usable.all(axis=1) for tile in run])
    if not usable.any():
        return
    around, torque = _join_tiles(run)
    # in between, only ends of a log could be unusable
    first, last = (run[0].first + every * int(index) for index in np.flatnonzero(usable)[[0, -1]])
    torque = torque[first : last + 1]
    # what the filters spoil at a log's ends is no motion
    begin = 0 if usable[0] else first
    around = around.at(slice(begin, None if usable[-1] else last + 1))
    inside = slice(first - begin, last + 1 - begin)
    state = around.at(inside)
    time = state.time
    if time is not None and len(time) > 1:
        step = float(time[-1] - time[0]) / (len(time) - 1)
        yield Stretch(key, step, every, time, state, torque, around, inside)


def _join_tiles(run: list[Tile]) -> tuple[MotionState, JointSeries]:
    """Join tiles: of each its own samples, and what lies before the first and after the last one."""
    parts = []
    for number, tile in enumerate(run):
        end = tile.first + tile.parallel.decimation * len(tile.time)
        parts.append(slice(tile.first if number else 0, end if number < len(run) - 1 else None))
    states = [tile.state.at(part) for tile, part in zip(run, parts, strict=True)]
    torque = np.concatenate([tile.torque[part] for tile, part in zip(run, parts, strict=True)])
    return concatenate_states(states), torque


def _cut_windows(stretch: Stretch, seconds: float, every: float, drive: DrivenBy) -> Windows | None:
    length = round(seconds / stretch.step)
    stride = stretch.every * max(1, round(every / (stretch.every * stretch.step)))
    begins = np.arange(0, len(stretch.time) - length, stride)
    if not len(begins):
        return None
    rows = begins[None, :] + np.arange(length + 1)[:, None]
    position, velocity, torque = (
        np.ascontiguousarray(series[rows].transpose(0, 2, 1))
        for series in (stretch.state.position, stretch.state.velocity, drive(stretch))
    )
    keys = (stretch.key,) * len(begins)
    start = stretch.state.at(begins)
    return Windows(stretch.step, stretch.time[begins], keys, start, position, velocity, torque)


def _join_windows(pile: list[Windows]) -> Windows:
    """Put windows of one clock side by side."""
    begins = np.concatenate([windows.begins for windows in pile])
    start = concatenate_states([windows.start for windows in pile])
    position, velocity, torque = (
        np.concatenate([getattr(windows, name) for windows in pile], axis=2)
        for name in ("position", "velocity", "torque")
    )
    keys = tuple(key for windows in pile for key in windows.keys)
    return Windows(pile[0].step, begins, keys, start, position, velocity, torque)
