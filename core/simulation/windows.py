"""Cut measured motion into windows that start at kept instants and end within the same block of the log.

A window never crosses a gap, the border of a block, or what the filters spoil at a log's ends; standing
joints stay in, because a simulation has to get standstill right too.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from core.arrays import JointSeries, Samples
from core.errors import LogError
from core.regressor.observe import BlockKey
from core.signals.condition import Motion, without_standstill_mask
from core.signals.state import MotionState
from core.signals.tile import Tile


@dataclass(frozen=True, eq=False)
class Stretch:
    """Hold unbroken measured motion within one block of one log, at the log's rate.

    Attributes
    ----------
    key
        Log and block number, from 0.
    step
        Time between samples, s.
    every
        Samples between two kept instants; the first sample is one.
    """

    key: BlockKey
    step: float
    every: int
    time: Samples
    state: MotionState
    torque: JointSeries


@dataclass(frozen=True, eq=False)
class Windows:
    """Hold windows of equal length side by side, (instants, joints, windows), all of one clock.

    Attributes
    ----------
    step
        Time between instants, s.
    begins
        Where each window begins, s.
    keys
        Log and block of each window.
    start
        The measured state each window begins with, one row per window.
    """

    step: float
    begins: Samples
    keys: tuple[BlockKey, ...]
    start: MotionState
    position: np.ndarray
    velocity: np.ndarray
    torque: np.ndarray


def stretches(motions: tuple[Motion, ...], chosen: frozenset[BlockKey] | None = None) -> Iterator[Stretch]:
    """Go through the motions block by block (all blocks by default)."""
    for log, motion in enumerate(motions):
        run: list[Tile] = []
        for tile in without_standstill_mask(motion).tiles():
            if run and not (tile.follows and tile.block == run[-1].block):
                yield from _joined(log, run, chosen)
                run = []
            run.append(tile)
        yield from _joined(log, run, chosen)


def windows(
    motions: tuple[Motion, ...], seconds: float, every: float, chosen: frozenset[BlockKey] | None = None
) -> Iterator[Windows]:
    """Cut windows of a length, one every so many seconds; those of one clock come together.

    Raises
    ------
    LogError
        If no chosen block is as long as a window.
    """
    pile: list[Windows] = []
    longest, found = 0.0, False
    for stretch in stretches(motions, chosen):
        longest = max(longest, stretch.step * (len(stretch.time) - 1))
        cut = _cut(stretch, seconds, every)
        if cut is None:
            continue
        found = True
        if pile and not same_clock(pile[-1].step, cut.step):
            yield _beside(pile)
            pile = []
        pile.append(cut)
    if not found:
        raise LogError(
            "no block of the log is as long as a simulated window",
            evidence={"window_seconds": seconds, "longest_seconds": longest},
            remedy="simulate shorter windows, divide the log into fewer blocks, or record a longer log",
        )
    yield _beside(pile)


def same_clock(one: float, other: float) -> bool:
    """Tell whether two steps (s) differ by rounding only."""
    return abs(one - other) <= 1e-6 * one


def _joined(log: int, run: list[Tile], chosen: frozenset[BlockKey] | None) -> Iterator[Stretch]:
    if not run or (chosen is not None and (log, run[0].block) not in chosen):
        return
    every = run[0].parallel.decimation
    usable = np.concatenate([tile.usable.all(axis=1) for tile in run])
    if not usable.any():
        return
    slices = [slice(tile.first, tile.first + every * len(tile.time)) for tile in run]
    # the first usable instant to the last one; in between, only ends of a log could be unusable
    first, last = (int(one) for one in np.flatnonzero(usable)[[0, -1]])
    kept = slice(first * every, last * every + 1)
    parts = [_inner(tile, one) for tile, one in zip(run, slices, strict=True)]
    position, velocity, acceleration, torque = (
        np.concatenate([part[place] for part in parts])[kept] for place in range(4)
    )
    temperature = np.concatenate([part[4] for part in parts])[kept]
    step = float(run[0].time[1] - run[0].time[0]) / every if len(run[0].time) > 1 else 0.0
    if step > 0.0 and len(position) > 1:
        time = run[0].time[0] + step * (first * every + np.arange(len(position)))
        warm = temperature if temperature.shape[1] else None
        state = MotionState(position, velocity, acceleration, time, warm)
        yield Stretch((log, run[0].block), step, every, time, state, torque)


def _inner(tile: Tile, part: slice) -> tuple[np.ndarray, ...]:
    state = tile.state
    warm = np.empty((len(state.position), 0)) if state.temperature is None else state.temperature
    return tuple(one[part] for one in (state.position, state.velocity, state.acceleration, tile.torque, warm))


def _cut(stretch: Stretch, seconds: float, every: float) -> Windows | None:
    length = round(seconds / stretch.step)
    stride = stretch.every * max(1, round(every / (stretch.every * stretch.step)))
    begins = np.arange(0, len(stretch.time) - length, stride)
    if not len(begins):
        return None
    rows = begins[None, :] + np.arange(length + 1)[:, None]
    position, velocity, torque = (
        np.ascontiguousarray(one[rows].transpose(0, 2, 1))
        for one in (stretch.state.position, stretch.state.velocity, stretch.torque)
    )
    measured = stretch.state
    warm = None if measured.temperature is None else measured.temperature[begins]
    start = MotionState(
        measured.position[begins],
        measured.velocity[begins],
        measured.acceleration[begins],
        stretch.time[begins],
        warm,
    )
    keys = (stretch.key,) * len(begins)
    return Windows(stretch.step, stretch.time[begins], keys, start, position, velocity, torque)


def _beside(pile: list[Windows]) -> Windows:
    """Put windows of one clock side by side."""
    states = [one.start for one in pile]
    warm = [state.temperature for state in states if state.temperature is not None]
    begins = np.concatenate([one.begins for one in pile])
    start = MotionState(
        np.vstack([state.position for state in states]),
        np.vstack([state.velocity for state in states]),
        np.vstack([state.acceleration for state in states]),
        begins,
        np.vstack(warm) if len(warm) == len(states) else None,
    )
    position, velocity, torque = (
        np.concatenate([getattr(one, name) for one in pile], axis=2)
        for name in ("position", "velocity", "torque")
    )
    keys = tuple(key for one in pile for key in one.keys)
    return Windows(pile[0].step, begins, keys, start, position, velocity, torque)
