"""Take whole turns out of angles that a recorder wrapped, as at 0 and 360 degrees.

A step of a whole turn, but for what the joint moves meanwhile, is none of its motion: the angle of a revolute
joint is the same with or without it. What is left of such a step has to be no jump itself, while the step is
one; so an angle that rests where it is wrapped, and comes back in the next row, is followed as well. A
wrapped angle spans no more than one turn: steps of 6.28 degrees that were declared as rad are none.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ...arrays import Indices, Samples
from ..defects.stretch import JUMP_FACTOR, count_text, usual_step
from ..model import Defect, LogRows, LogSource

TURNS = (2.0 * np.pi, 360.0)
"""A turn in rad, and one of degrees that were declared as rad."""
BORDER = 1.001
"""Of a turn: what a wrapped angle spans at most, with its rounding."""


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
    _leaps: dict[int, list[list[Wrapped]]] = field(default_factory=dict)
    """By joint and kind of turn."""
    _low: dict[int, float] = field(default_factory=dict)
    _high: dict[int, float] = field(default_factory=dict)
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
        own = angles[known]
        self._low[joint] = min(self._low.get(joint, np.inf), float(own.min()))
        self._high[joint] = max(self._high.get(joint, -np.inf), float(own.max()))
        self._last[joint] = float(own[-1])
        steps = np.diff(own)
        if np.abs(steps).max(initial=0.0) <= 0.5 * TURNS[0]:
            return
        leaps = self._leaps.setdefault(joint, [[] for _ in TURNS])
        for found, turn in zip(leaps, TURNS, strict=True):
            added = _added(steps, turn)
            at = np.flatnonzero(added)
            found.append(Wrapped(first + known[at + 1], added[at]))

    @property
    def found(self) -> dict[int, Wrapped]:
        """Give the wrapped joints, from 0: their angles stay within one turn."""
        found = {}
        for joint, leaps in self._leaps.items():
            span = self._high[joint] - self._low[joint]
            parts = next((own for own, turn in zip(leaps, TURNS, strict=True) if span <= BORDER * turn), [])
            if any(len(part.rows) for part in parts):
                found[joint] = Wrapped(
                    np.concatenate([part.rows for part in parts]),
                    np.concatenate([part.added for part in parts]),
                )
        return found


def _added(steps: Samples, turn: float) -> Samples:
    """Give the whole turns that take the place of leaps; zero elsewhere."""
    added = -turn * np.round(steps / turn)
    left = np.abs(steps + added)
    jump = JUMP_FACTOR * usual_step(left)
    leaps = (np.abs(added) == turn) & (left <= jump)
    return np.where(leaps, added, 0.0) if jump < 0.5 * turn else np.zeros(len(steps))


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
