"""Restore the torque of a channel with a dead zone, and leave out the rows where it cannot be restored.

Where such a channel reads zero, its torque is anything within the zone, and a filter mixes that with what is
read around. What a zone takes from larger torques is known.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import JointMask, JointVector, Samples
from ..log.corrected import CorrectedSource
from ..log.model import JointLog, LogRows
from ..robot.model import RobotModel
from .condition import effort_scale
from .resample import effort_of

EVEN = 0.5
"""Probability at which nothing tells whether there is a zone."""
_ROWS = 1 << 16
"""Samples that are read at a time."""


@dataclass(frozen=True, eq=False)
class DeadZone:
    """Hold the dead zone of a torque channel, within which it reads zero."""

    log: int
    joint: int
    """Number of the log and the joint, from 0."""
    half: float
    deviation: float
    """Half of its width and its deviation, N m or N."""
    shortfall: float
    """What it takes from what it passes, N m or N: nothing, as much, or half as much on average where the
    channel cuts off what is below its step."""
    zeros: int
    share: float
    """Samples in motion that read zero, and their share."""
    p_value: float

    @property
    def is_known(self) -> bool:
        """Tell whether there is evidence that the channel has it."""
        return self.p_value < EVEN

    def error(self, torque: Samples) -> Samples:
        """Give what the channel adds to a torque."""
        taken = np.where(np.abs(torque) < self.half, torque, np.copysign(self.shortfall, torque))
        return np.asarray(-taken)

    @property
    def cuts_off(self) -> bool:
        """Tell whether the channel cuts off what is below its step, which is half of the zone's width."""
        return 0.0 < self.shortfall < self.half


def zones_of(zones: Sequence[DeadZone], log: int) -> list[DeadZone]:
    """Give the zones of one log."""
    return [zone for zone in zones if zone.log == log]


def with_restored_torque(log: JointLog, robot: RobotModel, zones: Sequence[DeadZone]) -> JointLog:
    """Add what zones take from larger torques; where a channel reads zero, join those before and after."""
    if not zones:
        return log
    restoration = _Restoration(effort_scale(log, robot), tuple(zones))
    return replace(log, source=CorrectedSource(log, restoration.rows, 0), sha256="")


@dataclass(frozen=True, eq=False)
class _Restoration:
    """Restore the effort of rows in the channel that it was logged in."""

    effort_scale: JointVector
    """Per joint, torque per unit of the logged effort."""
    zones: tuple[DeadZone, ...]

    def rows(self, rows: LogRows) -> LogRows:
        """Restore a stretch without gaps."""
        effort = effort_of(rows).copy()
        for zone in self.zones:
            shortfall = zone.shortfall / self.effort_scale[zone.joint]
            effort[:, zone.joint] = _restored(rows.time, effort[:, zone.joint], shortfall)
        return replace(rows, **{"current" if rows.torque is None else "torque": effort})


def _restored(time: Samples, effort: Samples, shortfall: float) -> Samples:
    read = effort != 0.0
    if not read.any():
        return effort
    whole = effort[read] + np.copysign(shortfall, effort[read])
    return np.asarray(np.interp(time, time[read], whole))


def unread(log: JointLog, zones: Sequence[DeadZone], time: Samples, reach: float) -> JointMask:
    """Mark, per joint, the instants beside which a channel with a dead zone reads zero.

    Parameters
    ----------
    log
        The log as it was recorded.
    time
        Instants in s.
    reach
        How near a zero has to be, s.
    """
    marks = np.zeros((len(time), log.joints), dtype=bool)
    for zone in zones:
        zeros = np.concatenate([*_zeros(log, zone.joint)])
        first, last = (np.searchsorted(zeros, time + way * reach) for way in (-1.0, 1.0))
        marks[:, zone.joint] = last > first
    return marks


def _zeros(log: JointLog, joint: int) -> Iterator[Samples]:
    """Give the instants at which a channel reads zero."""
    for start in range(0, log.source.samples, _ROWS):
        rows = log.source.rows(start, min(start + _ROWS, log.source.samples))
        yield rows.time[effort_of(rows)[:, joint] == 0.0]
