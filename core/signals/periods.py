"""Find the period of a motion that repeats, and take the mean of its other periods in the place of each.

The noise of one period's positions is not that of another. So the other periods know the motion without the
noise of this one: they are instruments that need neither a simulation nor a controller. Source: Soderstrom &
Stoica, System Identification (1989), ch. 8; Pintelon & Schoukens, System Identification (2012), ch. 2.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np

from ..arrays import Indices, JointSeries, Samples, Vector
from ..errors import LogError
from ..robot.joint_units import prismatic_joints
from ..robot.model import RobotModel
from .condition import Motion
from .parallel import Tile
from .segment import UNUSABLE_SHARE
from .state import MotionState

REPEATS: Final = 0.1
"""Largest RMS difference of two periods, as a share of the motion's own RMS. Noise of positions is far below
it, and another motion far above: two that have nothing in common differ by 1.4. Set by hand."""
LEAVES: Final = 0.5
"""Share of the motion's RMS that a motion goes away before it can come back. Set by hand."""
MOST_SAMPLES: Final = 200_000
"""Samples in which a period is looked for: it may last 100 s at 1 kHz. Set by hand."""
NOISES: Final = 2.0
"""Two positions differ by 1.4 times the noise of one, and seldom by more than this."""
SEVERAL: Final = 2
"""Periods that a log has at least."""


@dataclass(frozen=True, eq=False)
class OtherPeriods:
    """Give the tiles of a motion with the mean of all other periods in the place of what was measured."""

    motion: Motion
    period: float
    """Samples, not always a whole number."""

    @property
    def kept(self) -> int:
        """Count the decimated samples."""
        return self.motion.kept

    @property
    def seconds(self) -> float:
        """Give the period in s."""
        return self.period / self._rate_hz

    @property
    def _rate_hz(self) -> float:
        return float(self.motion.segments[0].rate_hz)

    def tiles(self) -> Iterator[Tile]:
        """Go once through the motion; instants whose phase no other period shows are not usable."""
        sums, counts = self._sums
        for tile in self.motion.tiles():
            phase = self._phase(tile.state)
            others = counts[phase] - 1
            mean = (sums[phase] - _stacked(tile.state)) / np.maximum(others, 1)[:, None, None]
            position, velocity, acceleration = np.moveaxis(mean, 1, 0)
            alone = (others < 1)[None].astype(float)
            unknown = tile.parallel.influence(alone, tile.first, len(tile.time))[0] > UNUSABLE_SHARE
            yield replace(
                tile,
                state=replace(tile.state, position=position, velocity=velocity, acceleration=acceleration),
                usable=tile.usable & ~unknown[:, None],
            )

    @cached_property
    def _sums(self) -> tuple[np.ndarray, Indices]:
        """Add up position, velocity and acceleration of all periods at every phase; count the periods."""
        phases = int(np.ceil(self.period)) + 1
        sums = np.zeros((phases, 3, len(self.motion.effort_scale)))
        counts, last = np.zeros(phases, dtype=int), -np.inf
        for tile in self.motion.tiles():
            time = _clock(tile.state)
            fresh = slice(int(np.searchsorted(time, last, side="right")), None)
            phase = self._phase(tile.state.at(fresh))
            np.add.at(sums, phase, _stacked(tile.state.at(fresh)))
            np.add.at(counts, phase, 1)
            last = max(last, float(time[-1]) + 0.5 / self._rate_hz)
        return sums, counts

    def _phase(self, state: MotionState) -> Indices:
        """Give the samples since the last beginning of a period."""
        since = (_clock(state) - self.motion.segments[0].begin_time) * self._rate_hz
        # half a sample on, so that rounding of the clock opens no new period early
        return np.asarray(np.mod(since + 0.5, self.period).astype(int))


def other_periods(motion: Motion, robot: RobotModel) -> OtherPeriods:
    """Find the period of a motion.

    Raises
    ------
    LogError
        If the motion does not repeat.
    """
    segment = max(motion.segments, key=lambda one: one.samples)
    position = segment.measured_positions(0, min(segment.samples, MOST_SAMPLES))
    apart = _apart(_scaled(position, robot))
    away = apart > LEAVES
    begin = int(np.argmax(away)) if away.any() else len(apart)
    returns = _minima(apart[begin:])
    found = [begin + int(place) + 1 for place in returns if apart[begin + place] <= REPEATS]
    if found:
        _check_joints(motion, position, found[0])
        return OtherPeriods(motion, _refined(apart, found[0], segment.samples))
    nearest = {}
    if len(returns):
        place = begin + int(returns[np.argmin(apart[begin + returns])])
        nearest = {
            "nearest_period_s": round((place + 1) / segment.rate_hz, 3),
            "difference_percent": round(100.0 * float(apart[place]), 1),
        }
    raise LogError(
        "the motion does not repeat, so that no period can stand for another",
        evidence={"log": motion.log.name, **nearest, "allowed_percent": 100.0 * REPEATS},
        remedy=f"record more than {SEVERAL} periods of one motion, or simulate by replay",
    )


def _check_joints(motion: Motion, position: JointSeries, period: int) -> None:
    """Refuse a period that is that of the largest motions only."""
    apart = np.sqrt(np.mean((position[period:] - position[:-period]) ** 2, axis=0))
    allowed = REPEATS * position.std(axis=0) + NOISES * motion.recipe.position_noise
    others = np.flatnonzero((apart > allowed) & ~motion.recipe.held)
    if len(others):
        raise LogError(
            "some joints do not repeat their motion with the others",
            evidence={
                "log": motion.log.name,
                "joints": (others + 1).tolist(),
                "period_s": round(period / motion.segments[0].rate_hz, 3),
                "difference_rms": [float(f"{value:.3g}") for value in apart[others]],
            },
            remedy="let all joints repeat with one period, or simulate by replay",
        )


def _scaled(position: JointSeries, robot: RobotModel) -> JointSeries:
    """Divide a motion by its RMS about its mean; what turns and what slides count alike."""
    moved = position - position.mean(axis=0)
    prismatic = prismatic_joints(robot)
    for kind in (prismatic, ~prismatic):
        size = float(np.sqrt(np.mean(np.sum(moved[:, kind] ** 2, axis=1)))) if kind.any() else 0.0
        moved[:, kind] /= size if size > 0.0 else 1.0
    kinds = int(prismatic.any()) + int((~prismatic).any())
    return np.asarray(moved / np.sqrt(kinds))


def _apart(motion: JointSeries) -> Vector:
    """Give the RMS difference of a motion from itself one, two, ... samples later, up to half its length."""
    from scipy.signal import correlate  # takes a second to load

    length = len(motion)
    lags = np.arange(1, length // SEVERAL + 1)
    square = np.append(0.0, np.cumsum(np.sum(motion**2, axis=1)))
    product = sum(correlate(column, column, method="fft")[length - 1 :] for column in motion.T)
    both = square[length - lags] + square[length] - square[lags] - 2.0 * np.asarray(product)[lags]
    return np.asarray(np.sqrt(np.maximum(both, 0.0) / (length - lags)))


def _minima(values: Vector) -> Indices:
    """Give the places of local minima, without those at the ends."""
    inner = values[1:-1]
    return np.flatnonzero((inner <= values[:-2]) & (inner <= values[2:])) + 1


def _refined(apart: Vector, period: int, samples: int) -> float:
    """Give a period to a part of a sample: many periods later it is known that much better."""
    found = float(period)
    for periods in (1, max(1, int(len(apart) // found))):
        centre = round(periods * found)
        lags = np.arange(max(1, centre - 2), min(len(apart), centre + 2) + 1)
        found = float(lags[0] + _vertex(apart[lags - 1] ** 2)) / periods
    whole = round(found)
    drift = abs(found - whole) * samples / found
    return float(whole) if drift < 0.5 else found


def _vertex(values: Vector) -> float:
    """Give the place of a minimum from the parabola through its neighbours.

    Examples
    --------
    >>> round(_vertex((np.arange(7) - 3.3) ** 2), 6)
    3.3
    """
    at = int(np.argmin(values))
    if not 0 < at < len(values) - 1:
        return float(at)
    before, here, after = values[at - 1 : at + 2]
    bend = before - 2.0 * here + after
    return at + 0.5 * float(before - after) / float(bend) if bend > 0.0 else float(at)


def _stacked(state: MotionState) -> np.ndarray:
    """Give samples x (position, velocity, acceleration) x joints."""
    return np.stack([state.position, state.velocity, state.acceleration], axis=1)


def _clock(state: MotionState) -> Samples:
    """Give the instants of conditioned motion, which are always known."""
    return np.asarray(state.time)
