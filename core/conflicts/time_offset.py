"""Find how much later or earlier than the positions a log's torques come: two recorders, two clocks.

A drive's or a filter's delay is a cause with a size. A longer one is that of clocks. The positions' equations
are the same for every offset, and so all of them are bounded with the products of one observation matrix.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..log.columns.assignment import Channels
from ..signals.condition import Motion
from .path import Margins
from .samples import SERIES, Samples, filtered_series
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
    reach = int(TIME_OFFSET.furthest / step)
    samples = _samples(motion, reach)
    if samples is None:
        return None
    trials = Trials(samples, terms)
    equations = trials.equations(setup)
    offsets = range(-reach, reach + 1)
    shifted = [setup.with_torque(_later(setup.assignment.torque, offset + reach)) for offset in offsets]
    bounds = np.array([equations.regressor.products.read(own.assignment.torque).bound for own in shifted])
    best = int(np.argmin(bounds))
    seconds = step * (offsets[best] + _vertex(bounds[max(best - 1, 0) : best + 2]))
    if abs(seconds) < TIME_OFFSET.least:
        return None
    before, after = (trials.outcome(trials.equations(own)) for own in (shifted[reach], shifted[best]))
    if before is None or after is None:
        return None
    needed = max(Margins.of(before, trials).needed(len(shifted)), -np.log(DECISION.least_share))
    return TimeOffset(seconds, before, after) if before.score - after.score > needed else None


def _samples(motion: Motion, reach: int) -> Samples | None:
    """Take instants with the torques of all joints at every offset, one after the other."""
    stride = max(1, -(-motion.kept // TRIAL.rows))
    parts = []
    for run in _runs(motion):
        rows = np.arange(reach, len(run["torque"]) - reach, stride)
        offsets = range(-reach, reach + 1)
        torque = np.hstack([run["torque"][rows + offset] for offset in offsets]) if len(rows) else None
        if torque is not None:
            parts.append({name: values[rows] for name, values in run.items()} | {"torque": torque})
    if not parts:
        return None
    series = {name: np.concatenate([part[name] for part in parts]) for name in SERIES}
    cycles = motion.log.duration * motion.recipe.motion_band_hz
    independent = max(1.0, float(series["judged"].mean() * 2.0 * cycles))
    measured = ~motion.segments[0].unmeasured
    return Samples(**series, measured=measured, independent=independent)


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
    return Channels(source, channels.factor, channels.offset)


def _vertex(bounds: np.ndarray) -> float:
    """Give where the parabola through the least bound and its neighbours is least, in steps."""
    if len(bounds) < 3:
        return 0.0
    left, middle, right = bounds
    return float(0.5 * (left - right) / max(left - 2.0 * middle + right, np.finfo(float).tiny))
