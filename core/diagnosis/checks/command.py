"""Hold the torque against the command that the drives were given: delay and gain, without a model.

A drive makes the torque that it is asked for. So what a torque channel does to its signal shows beside the
logged command, whatever the robot's model lacks. Both are filtered alike, and the torque is fitted by the
command, shifted and multiplied, and a constant. A channel that follows its command closely has no filter:
what is found as one is something else. Both may be recorded later than the positions.
Source: Ljung, System Identification (1999), ch. 10.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.interpolate import CubicSpline

from ...arrays import JointVector, Matrix, Samples, Vector
from ...numerics.filtering import convolved
from ...signals.condition import Motion
from ...signals.resample import linear
from ..causes.protocol import Site, number_text
from ..causes.time_delay import TimeDelay
from ..causes.torque_filter_lag import TorqueFilterLag
from ..causes.torque_gain import TorqueGain
from ..result import Evidence
from ..thresholds.checks import COMMAND

AGAINST_COMMAND: Final = "against the command"
"""Name of the statistic: the delay in s, or the gain error."""


@dataclass(frozen=True, eq=False)
class Channel:
    """Hold what the torque channels do to the command, joint by joint."""

    command: str
    """Name of the channel with the command."""
    delay: JointVector
    delay_deviation: JointVector
    """By how much the torque comes later, s."""
    gain: JointVector
    gain_deviation: JointVector
    """Torque per unit of the command; all four NaN where a joint tells nothing."""

    def delay_at(self, site: Site) -> tuple[float, float] | None:
        """Give the delay of a joint, or that of all joints together, and its deviation, s."""
        joints = np.array(site) - 1 if site else np.arange(len(self.delay))
        known = joints[np.isfinite(self.delay[joints]) & (self.delay_deviation[joints] > 0.0)]
        if not len(known):
            return None
        weight = self.delay_deviation[known] ** -2.0
        return float(weight @ self.delay[known] / weight.sum()), float(weight.sum() ** -0.5)

    def late(self, site: Site) -> Iterator[Evidence]:
        """State the delay of a joint, or that of all joints together."""
        told = self.delay_at(site)
        if told is None:
            return
        delay, doubt = told
        way = "behind" if delay > 0.0 else "ahead of"
        size = f"{number_text(1e3 * abs(delay), 3)} ± {number_text(1e3 * doubt)} ms"
        yield Evidence(
            f"Without a model: the torque is {size} {way} the logged {self.command}", AGAINST_COMMAND, delay
        )

    def apart(self, site: Site) -> Iterator[Evidence]:
        """Give the gain of a joint against the middle one of all, where commands are torques."""
        known = self.gain[np.isfinite(self.gain)]
        if not site or self.command != "torque_ref" or len(known) < COMMAND.least_joints:
            return
        middle, own = float(np.median(known)), site[0] - 1
        error, doubt = self.gain[own] / middle - 1.0, self.gain_deviation[own] / middle
        if np.isfinite(error):
            size = f"{number_text(100.0 * error, 3)} ± {number_text(100.0 * doubt)} %"
            yield Evidence(
                f"Without a model: per {self.command} the torque differs by {size} from the other joints'",
                AGAINST_COMMAND,
                float(error),
            )


def command_evidence(motions: tuple[Motion, ...], cause: str, site: Site) -> tuple[Evidence, ...]:
    """Say what the command tells of a finding on a torque channel; nothing of any other finding."""
    if cause not in _TOLD:
        return ()
    channel = channel_of(motions)
    return () if channel is None else tuple(_TOLD[cause](channel, site))


def contradicted_by_command(motions: tuple[Motion, ...], cause: str, site: Site, lag: float) -> bool:
    """Tell whether the command surely shows less than half of a lag (s) that was found of a torque filter."""
    channel = channel_of(motions) if cause == TorqueFilterLag.id else None
    told = None if channel is None else channel.delay_at(site)
    return told is not None and told[0] + COMMAND.deviations * told[1] < COMMAND.least_shown * lag


def channel_of(motions: tuple[Motion, ...]) -> Channel | None:
    """Hold the torques of the first log that has both against its command; None where none has."""
    for motion in motions:
        for name in ("torque_ref", "command"):
            if {name, "torque"} <= set(motion.log.channels):
                return _channel(motion, name)
    return None


def _channel(motion: Motion, name: str) -> Channel:
    """Fit delay and gain of every joint over the longest gap-free part."""
    segment = max(motion.segments, key=lambda one: one.samples)
    count = min(segment.samples, COMMAND.most_samples)
    rows = motion.log.source.rows(segment.start, segment.start + count)
    grid = rows.time[0] + np.arange(count) / segment.rate_hz
    asked, made = (np.asarray(getattr(rows, channel)) for channel in (name, "torque"))
    pairs = [linear(grid, rows.time, series) for series in (asked, made)]
    low_pass = segment.parallel.response
    filtered = [convolved(series, low_pass) for series in pairs]
    fits = [
        _fitted(command, torque, 1.0 / segment.rate_hz, motion.recipe.decimation)
        for command, torque in zip(filtered[0].T, filtered[1].T, strict=True)
    ]
    delay, gain, delay_deviation, gain_deviation = np.array(fits).T
    return Channel(name, delay, delay_deviation, gain, gain_deviation)


def _fitted(command: Samples, torque: Samples, step: float, thin: int) -> Vector:
    """Give delay and gain, then their deviations; NaN where the two have nothing in common."""
    reach = int(np.ceil(COMMAND.longest / step))
    kept = np.arange(reach, len(torque) - reach, thin)
    spline, values = CubicSpline(np.arange(len(command)), command), np.array([0.0, 1.0])
    unknown = np.full(2 * len(values), np.nan)
    if len(kept) <= COMMAND.blocks * len(unknown):
        return unknown

    def equations() -> tuple[Matrix, Samples]:
        at = kept - values[0] / step
        columns = np.column_stack([-spline(at, 1) / step * values[1], spline(at), np.ones(len(kept))])
        return columns, torque[kept] - columns[:, 1] * values[1]

    for _ in range(COMMAND.steps):
        columns, left = equations()
        change, _, rank, _ = np.linalg.lstsq(columns, left, rcond=None)
        values = values + change[:2]
        if rank < len(change) or not abs(values[0]) < COMMAND.longest or not values[1] > 0.0:
            return unknown
    columns, left = equations()
    left -= left.mean()
    if np.linalg.norm(left) <= COMMAND.same * np.linalg.norm(torque - torque.mean()):
        return unknown
    return np.concatenate([values, _deviations(columns, left)[:2]])


def _deviations(columns: Matrix, left: Samples) -> Vector:
    """Give the deviations of least squares from the scatter of what blocks of rows add."""
    triangle = np.asarray(np.linalg.qr(columns, mode="r"))
    blocks = (np.array_split(part, COMMAND.blocks) for part in (columns, left))
    sums = np.column_stack([part.T @ own for part, own in zip(*blocks, strict=True)])
    return np.asarray(np.linalg.norm(np.linalg.solve(triangle, np.linalg.solve(triangle.T, sums)), axis=1))


_TOLD: Final[Mapping[str, Callable[[Channel, Site], Iterator[Evidence]]]] = {
    TimeDelay.id: Channel.late,
    TorqueFilterLag.id: Channel.late,
    TorqueGain.id: Channel.apart,
}
