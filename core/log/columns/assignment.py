"""Assign measured channels to joints: which column is whose, in which direction, from which zero.

A mapping file says it for a file's columns. Here it is a value that can be changed and tried: a log is read
through an assignment without being copied.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...arrays import JointSeries
from ..channels import TIME
from ..model import Defect, JointLog, LogRows, LogSource
from .binding import Binding
from .linkage import LINKED, Added, linked
from .mapping import RATE

_LIKE_TORQUE = ("torque", "current", "torque_ref", "command", "temperature")
_SIGNLESS = "temperature"
_MISSING = "missing_torque"


@dataclass(frozen=True)
class Channels:
    """Say, per joint, which measured channel is its own (from 0), and what turns it into the joint's."""

    source: tuple[int, ...]
    factor: tuple[float, ...]
    offset: tuple[float, ...]
    """Added to a position after the factor, rad or m; zero for torques."""
    added: tuple[Added, ...]
    """What is then added of other joints' positions; nothing for torques."""

    @classmethod
    def as_measured(cls, joints: int) -> "Channels":
        """Take every channel as it was measured."""
        return cls(tuple(range(joints)), (1.0,) * joints, (0.0,) * joints, ((),) * joints)

    @classmethod
    def picked(cls, several: Sequence["Channels"]) -> "Channels":
        """Take the first joint as the first of several says, the second as the second, and so on."""
        rows = [own.of_joint(joint) for joint, own in enumerate(several)]
        return cls(*zip(*rows, strict=True))

    def of_joint(self, joint: int) -> tuple[int, float, float, Added]:
        """Give source, factor and offset of a joint (from 0), and what is added to it."""
        return self.source[joint], self.factor[joint], self.offset[joint], self.added[joint]

    def exchanged(self, first: int, second: int) -> "Channels":
        """Exchange the channels of two joints, with their factors and offsets."""
        order = list(range(len(self.source)))
        order[first], order[second] = second, first
        return self.in_order(order)

    def in_order(self, order: Sequence[int]) -> "Channels":
        """Take, for every joint, the channel of another, with its factor and offset."""
        source, factor, offset, _ = zip(*map(self.of_joint, order), strict=True)
        return Channels(source, factor, offset, self.added)

    def scaled(self, factor: float, *joints: int) -> "Channels":
        """Multiply the channels of some joints."""
        scale = [factor if joint in joints else 1.0 for joint in range(len(self.source))]
        return replace(self, factor=_times(self.factor, scale), offset=_times(self.offset, scale))

    def moved(self, offset: float, joint: int) -> "Channels":
        """Add an offset to the channel of one joint."""
        added = [value + (offset if place == joint else 0.0) for place, value in enumerate(self.offset)]
        return replace(self, offset=tuple(added))

    def with_added(self, factor: float, other: int, joint: int) -> "Channels":
        """Add the position of another joint, times a factor, to that of a joint."""
        own = dict(self.added[joint])
        own[other] = own.get(other, 0.0) + factor
        pairs = tuple((place, value) for place, value in sorted(own.items()) if value)
        return replace(self, added=(*self.added[:joint], pairs, *self.added[joint + 1 :]))

    def of(self, measured: JointSeries, *, rate: bool = False) -> JointSeries:
        """Give the joints' series; a rate of change has no offset."""
        scaled = measured[:, list(self.source)] * np.array(self.factor)
        return linked(np.asarray(scaled if rate else scaled + np.array(self.offset)), self.added)


@dataclass(frozen=True)
class Assignment:
    """Hold the channels of positions and of torques, and the factor on all stamps."""

    position: Channels
    torque: Channels
    time_factor: float = 1.0

    @classmethod
    def as_measured(cls, joints: int) -> "Assignment":
        """Take everything as it was measured.

        Examples
        --------
        >>> Assignment.as_measured(2).torque.scaled(-1.0, 1).factor
        (1.0, -1.0)
        """
        return cls(Channels.as_measured(joints), Channels.as_measured(joints))


@dataclass(frozen=True, eq=False)
class AssignedSource:
    """Read samples through an assignment."""

    measured: LogSource
    assignment: Assignment

    @property
    def samples(self) -> int:
        """Count the rows."""
        return self.measured.samples

    def rows(self, start: int, stop: int) -> LogRows:
        """Read the rows from start up to, not including, stop."""
        rows, assignment = self.measured.rows(start, stop), self.assignment
        there = rows.channels()
        channels = {
            name: assignment.position.of(there[name], rate="velocity" in name)
            for name in LINKED
            if name in there
        } | {name: assignment.torque.of(there[name]) for name in _LIKE_TORQUE if name in there}
        if _SIGNLESS in there:
            channels[_SIGNLESS] = there[_SIGNLESS][:, list(assignment.torque.source)]
        return LogRows(rows.time * assignment.time_factor, **channels)


def assigned(log: JointLog, assignment: Assignment) -> JointLog:
    """Give a log as an assignment reads it; its defects follow their channels, or are answered by it."""
    if assignment == Assignment.as_measured(log.joints):
        return log
    factor = assignment.time_factor
    return replace(
        log,
        source=AssignedSource(log.source, assignment),
        rate_hz=log.rate_hz / factor,
        duration=log.duration * factor,
        defects=(
            *(
                _assigned_defect(defect, assignment)
                for defect in log.defects
                if not _is_answered(defect, assignment)
            ),
            *_left_out(log, assignment),
        ),
        bindings=tuple(_assigned_binding(binding, assignment) for binding in log.bindings),
    )


def _is_answered(defect: Defect, assignment: Assignment) -> bool:
    """Tell whether a defect is that of a size which the assignment changes."""
    channels = assignment.position if defect.channel in LINKED else assignment.torque
    factor = 1.0 if defect.joint is None else channels.factor[channels.source.index(defect.joint - 1)]
    if defect.kind != "implausible_unit":
        return factor == 0.0 and defect.kind != _MISSING
    return abs(assignment.time_factor if defect.joint is None else factor) != 1.0


def _left_out(log: JointLog, assignment: Assignment) -> list[Defect]:
    """Say of the torques that a factor of zero leaves out that they are not measured, if it is not said."""
    known = {defect.joint for defect in log.defects if defect.kind == _MISSING}
    ends = ((0.0, log.duration * assignment.time_factor),)
    return [
        Defect(
            _MISSING,
            "torque",
            joint + 1,
            log.source.samples,
            ends,
            f"Joint {joint + 1}'s torque is not used: what was logged as such is not its torque.",
        )
        for joint, factor in enumerate(assignment.torque.factor)
        if factor == 0.0 and assignment.torque.source[joint] + 1 not in known
    ]


def _assigned_defect(defect: Defect, assignment: Assignment) -> Defect:
    intervals = tuple(
        (begin * assignment.time_factor, end * assignment.time_factor) for begin, end in defect.intervals
    )
    if defect.joint is None:
        return replace(defect, intervals=intervals)
    like = assignment.position if defect.channel in LINKED else assignment.torque
    joint = like.source.index(defect.joint - 1)
    level = None if defect.level is None else defect.level * _factor(defect, like.factor[joint])
    return replace(defect, intervals=intervals, joint=joint + 1, level=level)


def _factor(defect: Defect, factor: float) -> float:
    """Give the factor of a level; a distance has no sign."""
    return factor if defect.kind == "saturation" else abs(factor)


def _assigned_binding(binding: Binding, assignment: Assignment) -> Binding:
    if binding.name == TIME:
        return binding
    channels = assignment.position if binding.name in LINKED else assignment.torque
    if binding.name == _SIGNLESS:
        channels = replace(Channels.as_measured(len(channels.source)), source=channels.source)
    if "velocity" in binding.name:
        channels = replace(channels, offset=(0.0,) * len(channels.source))
    return binding.reassigned(channels.source, channels.factor, channels.offset, channels.added)


def mapping_of(log: JointLog, prismatic: Collection[int] = ()) -> dict[str, object]:
    """Write the mapping with which a log's file is read as the log has it.

    A clock whose rate is not the stamps' is written as a rate, and lengths and forces as such at the joints,
    from 1, that are known to be prismatic.
    """
    mapping: dict[str, object] = {binding.name: binding.as_mapping(prismatic) for binding in log.bindings}
    factor = log.source.assignment.time_factor if isinstance(log.source, AssignedSource) else 1.0
    if TIME not in mapping or factor != 1.0:
        mapping |= {TIME: None, RATE: log.rate_hz}
    return mapping


def _times(values: tuple[float, ...], scale: list[float]) -> tuple[float, ...]:
    return tuple(value * factor for value, factor in zip(values, scale, strict=True))
