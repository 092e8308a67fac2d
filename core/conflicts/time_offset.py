"""Find how much later or earlier than the positions a log's torques come: two recorders, two clocks.

A drive's or a filter's delay is a cause with a size. A longer one is that of clocks. The positions' equations
are the same for every offset, and so all of them are bounded with the products of one observation matrix.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Indices
from ..log.columns.assignment import Channels
from ..signals.condition import Motion
from .parts import holds_in_parts
from .path import Margins
from .samples import SERIES, Samples, filtered_series, independent_values
from .setup import Setup
from .thresholds import DECISION, TIME_OFFSET, TRIAL
from .trial import Outcome, Trials


@dataclass(frozen=True, eq=False)
class TimeOffset:
    """Hold an offset of clocks that was found."""

    seconds: float
    """By which the torques come later than the positions."""
    before: Outcome
    after: Outcome


def time_offset(motion: Motion, setup: Setup, terms: tuple[str, ...] | None) -> TimeOffset | None:
    """Give the offset at which the model predicts a log's torques; None where none does so much better."""
    step = motion.recipe.decimation / motion.log.rate_hz
    every = max(1, round(TIME_OFFSET.furthest / (TIME_OFFSET.steps * step)))
    reach = int(TIME_OFFSET.furthest / (every * step))
    samples = _samples(motion, every * np.arange(-reach, reach + 1))
    if samples is None:
        return None
    trials = Trials(samples, terms)
    torque, count = setup.assignment.torque, 2 * reach + 1
    shifted = [setup.with_torque(_later(torque, place)) for place in range(count)]
    products = trials.equations(setup).regressor.products
    bounds = np.array([products.read(own.assignment.torque).bound for own in shifted])
    best = int(np.argmin(bounds))
    seconds = every * step * (best - reach + _vertex(bounds, best))
    before, after = (trials.outcome(own) for own in (shifted[reach], shifted[best]))
    if abs(seconds) < TIME_OFFSET.least or before is None or after is None:
        return None
    clear = _is_clear(before, after, trials, count) and holds_in_parts(shifted[reach], shifted[best], trials)
    return TimeOffset(seconds, before, after) if clear else None


def _is_clear(before: Outcome, after: Outcome, trials: Trials, tried: int) -> bool:
    """Tell whether the error falls to half at least, and by more than chance and the number of offsets."""
    needed = max(Margins.of(before, trials).needed(tried), -np.log(DECISION.least_share))
    return bool(before.score - after.score > needed)


def _samples(motion: Motion, offsets: Indices) -> Samples | None:
    """Take instants with the torques of all joints at every offset, one after the other."""
    stride = max(1, -(-motion.kept // TRIAL.rows))
    long = (run for run in _runs(motion) if len(run["torque"]) > 2 * offsets[-1])
    parts = [_with_offsets(run, offsets, stride) for run in long]
    if not parts:
        return None
    series = {name: np.concatenate([part[name] for part in parts]) for name in SERIES}
    cycles = motion.log.duration * motion.recipe.motion_band_hz
    measured = ~motion.segments[0].unmeasured
    count = independent_values(series, cycles)
    return Samples(**series, measured=measured, unsigned=np.zeros_like(measured), independent=count)


def _with_offsets(run: dict[str, np.ndarray], offsets: Indices, stride: int) -> dict[str, np.ndarray]:
    """Take instants of a stretch at which all offsets are within it."""
    rows = np.arange(offsets[-1], len(run["torque"]) + offsets[0], stride)
    torque = np.hstack([run["torque"][rows + offset] for offset in offsets])
    return {name: values[rows] for name, values in run.items()} | {"torque": torque}


def _runs(motion: Motion) -> Iterator[dict[str, np.ndarray]]:
    """Give the filtered series of every stretch without a gap; every third block judges."""
    tiles: list[dict[str, np.ndarray]] = []
    for tile in motion.tiles():
        if tiles and not tile.follows:
            yield _joined(tiles)
            tiles = []
        judged = tile.block % TRIAL.judged_every == 1
        tiles.append(filtered_series(tile) | {"usable": tile.usable, "judged": judged})
    if tiles:
        yield _joined(tiles)


def _joined(tiles: list[dict[str, np.ndarray]]) -> dict[str, np.ndarray]:
    return {name: np.concatenate([tile[name] for tile in tiles]) for name in SERIES}


def _later(channels: Channels, place: int) -> Channels:
    """Take the torques at an offset, which come after those at the offsets before."""
    joints = len(channels.source)
    source = tuple(place * joints + own for own in channels.source)
    return replace(channels, source=source)


def _vertex(bounds: np.ndarray, best: int) -> float:
    """Give where the parabola through the least bound and its neighbours is least, in steps from it."""
    if not 0 < best < len(bounds) - 1:
        return 0.0
    before, after = (bounds[best + way] - bounds[best] for way in (-1, 1))
    return float(0.5 * (before - after) / max(before + after, np.finfo(float).tiny))
