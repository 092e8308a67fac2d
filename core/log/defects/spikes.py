"""Find single samples that jump out of their neighbours, by their distance from a median of five.

A median of five follows steps and slopes but not a spike of one or two samples, so the distance is noise
where there is none. The scale is local, because a resting arm is quieter than a moving one.
"""

from dataclasses import replace

import numpy as np

from ...arrays import MarkTable, Matrix, Series, Vector
from ..model import Defect
from .runs import Runs
from .stretch import Facts, Stretch, count_text

SMALLEST_SHARE = {"position": 1e-3, "torque": 0.05, "current": 0.05}
"""Smaller jumps, as a share of the channel's range, are noise to everything that follows."""
NOISE_FACTOR = 20.0
INCREMENT_FACTOR = 4.0
RESOLUTION_FACTOR = 3.0
ROUNDS = 5
"""The largest spikes raise the mean distance; so often it is taken anew without those that are known."""


class Spikes:
    """Count the samples that stand apart in position, torque and current."""

    def __init__(self, joints: int) -> None:
        self._runs = {channel: [Runs() for _ in range(joints)] for channel in SMALLEST_SHARE}
        self._largest = {channel: np.zeros(joints) for channel in SMALLEST_SHARE}
        self._limits = {channel: np.full(joints, np.inf) for channel in SMALLEST_SHARE}

    def taken_from(self, stretch: Stretch) -> Stretch:
        """Note the samples that stand apart, and give the stretch with medians in their place.

        The first and last two samples have too few neighbours; the next stretch gives the last ones again.
        """
        usual = dict(stretch.channels)
        for channel, smallest_share in SMALLEST_SHARE.items():
            values = stretch.channels.get(channel)
            if values is None or values.shape[1] < 5:
                continue
            medians = median_of_five(values)
            spikes, limits = _apart(values, medians, smallest_share)
            for joint in np.flatnonzero(spikes.any(axis=1)):
                distance = np.abs(values[joint, 2:-2] - medians[joint])[spikes[joint]]
                self._note(channel, int(joint), float(distance.max()), float(limits[joint]))
                self._runs[channel][joint].feed(spikes[joint], stretch.time[2:-2])
                self._runs[channel][joint].close()
            usual[channel] = _replaced(values, medians, spikes)
        return replace(stretch, channels=usual)

    def _note(self, channel: str, joint: int, distance: float, limit: float) -> None:
        self._largest[channel][joint] = max(self._largest[channel][joint], distance)
        self._limits[channel][joint] = min(self._limits[channel][joint], limit)

    def defects(self, facts: Facts) -> list[Defect]:
        """State the spikes, channel by channel and joint by joint."""
        found = []
        for channel, all_runs in self._runs.items():
            for joint, runs in enumerate(all_runs):
                if runs.rows:
                    largest, span = self._largest[channel][joint], facts.span(channel)[joint]
                    unit = facts.units[channel][joint]
                    statement = (
                        f"Joint {joint + 1}'s {channel} differs from its neighbours in "
                        f"{count_text(runs.rows, 'sample')}, by up to {largest:.3g} {unit}; "
                        f"it spans {span:.3g} {unit} otherwise."
                    )
                    level = float(self._limits[channel][joint])
                    where = (joint + 1, runs.rows, runs.intervals)
                    found.append(Defect("outliers", channel, *where, statement, level))
        return found


def _apart(values: Series, medians: Matrix, smallest_share: float) -> tuple[MarkTable, Vector]:
    """Mark the samples that stand apart, and give the limits beyond which they do."""
    distance = np.abs(values[:, 2:-2] - medians)
    limits = _limits(values, distance, smallest_share)
    spikes = distance > limits[:, None]
    for _ in range(ROUNDS if spikes.any() else 0):
        limits = _limits(_replaced(values, medians, spikes), np.where(spikes, 0.0, distance), smallest_share)
        more = distance > limits[:, None]
        if not np.any(more & ~spikes):
            break
        spikes |= more
    return spikes, limits


def _replaced(values: Series, medians: Matrix, spikes: MarkTable) -> Series:
    if not spikes.any():
        return values
    usual = values.copy()
    usual[:, 2:-2][spikes] = medians[spikes]
    return usual


def median_of_five(values: Series) -> Matrix:
    """Take the median of every sample and its two neighbours on either side, row by row.

    Ten minima and maxima do it without sorting: the second smallest and second largest of four, then the
    median of three.

    Examples
    --------
    >>> median_of_five(np.array([[0.0, 1.0, 90.0, 3.0, 4.0, 5.0]]))
    array([[3., 4.]])
    """
    a, b, c, d, e = (values[:, k : values.shape[1] - 4 + k] for k in range(5))
    low = np.maximum(np.minimum(a, b), np.minimum(c, d))
    high = np.minimum(np.maximum(a, b), np.maximum(c, d))
    median: Matrix = np.maximum(np.minimum(low, high), np.minimum(np.maximum(low, high), e))
    return median


def _limits(values: Series, distance: Matrix, smallest_share: float) -> Vector:
    """Decide how far is apart.

    Many times the noise, several increments and resolution steps, and enough to matter.
    """
    increments = np.abs(np.diff(values, axis=1))
    limits: Vector = np.maximum(
        NOISE_FACTOR * distance.mean(axis=1) + INCREMENT_FACTOR * increments.mean(axis=1),
        smallest_share * np.ptp(values, axis=1),
    )
    for joint in np.flatnonzero(distance.max(axis=1) > limits):
        steps = increments[joint][increments[joint] > 0.0]
        limits[joint] = max(limits[joint], RESOLUTION_FACTOR * steps.min(initial=np.inf))
    return limits
