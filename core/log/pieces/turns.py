"""Take whole turns out of angles that a recorder wrapped, as at 0 and 360 degrees.

A step of a whole turn, but for what the joint moves meanwhile, is none of its motion: the angle of a revolute
joint is the same with or without it. What is left of such a step has to be no jump itself, while the step is
one; so an angle that rests where it is wrapped, and comes back in the next row, is followed as well.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ...arrays import Indices, Samples
from ..defects.stretch import JUMP_FACTOR, count_text, usual_step
from ..model import Defect, LogRows, LogSource

TURNS = (2.0 * np.pi, 360.0)
"""A turn in rad, and one of degrees that were declared as rad."""


@dataclass(frozen=True, eq=False)
class Wrapped:
    """Say where the angle of one joint was wrapped."""

    rows: Indices
    """Rows from which on whole turns are added."""
    added: Samples
    """What each of them adds, rad; as long."""


@dataclass(eq=False)
class Turns:
    """Collect the steps of whole turns between the rows that have a position.

    Attributes
    ----------
    units
        SI unit of each joint's position.
    """

    units: Sequence[str]
    _rows: dict[int, list[Indices]] = field(default_factory=dict)
    _added: dict[int, list[Samples]] = field(default_factory=dict)
    _last: dict[int, float] = field(default_factory=dict)

    def take(self, rows: LogRows, first: int) -> None:
        """Take the next rows, the first of which has this number."""
        for joint, unit in enumerate(self.units):
            if unit == "rad":
                self._follow(
                    joint, np.append(self._last.get(joint, np.nan), rows.position[:, joint]), first - 1
                )

    def _follow(self, joint: int, angles: Samples, first: int) -> None:
        known = np.flatnonzero(np.isfinite(angles))
        if not len(known):
            return
        self._last[joint] = float(angles[known[-1]])
        added = _added(np.diff(angles[known]))
        if added is not None:
            at = np.flatnonzero(added)
            self._rows.setdefault(joint, []).append(first + known[at + 1])
            self._added.setdefault(joint, []).append(added[at])

    @property
    def found(self) -> dict[int, Wrapped]:
        """Give the wrapped joints, from 0."""
        return {
            joint: Wrapped(np.concatenate(rows), np.concatenate(self._added[joint]))
            for joint, rows in self._rows.items()
        }


def _added(steps: Samples) -> Samples | None:
    """Give the whole turns that take the place of leaps; None where there are none."""
    if np.abs(steps).max(initial=0.0) <= 0.5 * TURNS[0]:
        return None
    for turn in TURNS:
        added = -turn * np.round(steps / turn)
        left = np.abs(steps + added)
        jump = JUMP_FACTOR * usual_step(left)
        leaps = (np.abs(added) == turn) & (left <= jump)
        if jump < 0.5 * turn and leaps.any():
            return np.where(leaps, added, 0.0)
    return None


class UnwrappedSource:
    """Give the samples of a source without the whole turns by which angles leap.

    A reference of the position, which may be wrapped elsewhere, is taken to the same turn.

    Examples
    --------
    >>> from veritorque.core.log.model import ArraySource
    >>> angle = np.array([6.1, 6.2, 0.02, 0.12])[:, None]
    >>> followed = UnwrappedSource(
    ...     ArraySource(LogRows(np.arange(4.0), angle)), {0: Wrapped(np.array([2]), np.array([6.283]))}
    ... )
    >>> followed.rows(1, 4).position[:, 0]
    array([6.2  , 6.303, 6.403])
    """

    def __init__(self, source: LogSource, wrapped: dict[int, Wrapped]) -> None:
        self._source, self._wrapped = source, wrapped
        self._sums = {joint: np.cumsum([0.0, *own.added]) for joint, own in wrapped.items()}

    @property
    def samples(self) -> int:
        """Count the rows."""
        return self._source.samples

    def rows(self, start: int, stop: int) -> LogRows:
        """Read the rows from start up to, not including, stop."""
        start, stop, _ = slice(start, stop).indices(self.samples)
        rows, numbers = self._source.rows(start, stop), np.arange(start, stop)
        position = rows.position.copy()
        reference = None if rows.position_ref is None else rows.position_ref.copy()
        for joint, own in self._wrapped.items():
            position[:, joint] += self._sums[joint][np.searchsorted(own.rows, numbers, side="right")]
            if reference is not None:
                turn = np.abs(own.added[0])
                ahead = reference[:, joint] - position[:, joint]
                reference[:, joint] -= turn * np.round(ahead / turn)
        return replace(rows, position=position, position_ref=reference)


def wrapped_defects(wrapped: dict[int, Wrapped]) -> list[Defect]:
    """State of every joint how often its angle was wrapped, and where first."""
    return [
        Defect("wrapped_angle", "position", joint + 1, len(own.rows), (), _statement(joint, own))
        for joint, own in sorted(wrapped.items())
    ]


def _statement(joint: int, own: Wrapped) -> str:
    turn = "360 degrees, declared as rad" if np.abs(own.added[0]) > TURNS[0] else "360 degrees"
    return (
        f"The angle of joint {joint + 1} leaps by a whole turn ({turn}) {count_text(len(own.rows), 'time')}, "
        f"first in row {own.rows[0] + 1}: it was wrapped, and is followed over the turns."
    )
