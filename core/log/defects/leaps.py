"""Refuse positions that leap: an angle that is wrapped, or a joint that is counted on from another zero.

A motion of limited bandwidth, sampled well, steps from row to row much as it did just before. A step that is
many times the steps on either side, and all usual ones, is no motion of that joint. Rows that a recorder has
missed look alike, but then every moving joint is farther on at once; a position that was held, or is, belongs
to a channel that hangs. A step of a whole turn is a wrapped angle, whatever else there is.
"""

from collections.abc import Callable, Collection, Sequence
from typing import NamedTuple

import numpy as np

from ...arrays import Mask, Samples, Series
from ...errors import LogError
from .stretch import GRID_STEPS, JUMP_FACTOR, USUAL_SHARE, Stretch

MOVING = 0.1
"""A joint moves that steps by this share of its mean step."""
ON_TIME = 2.0
"""A moving joint that steps by less than so many times its steps on either side has missed no row."""
TURNS = (2.0 * np.pi, 360.0)
"""Rad, and degrees that were declared as rad."""
TURN_SHARE = 0.016
"""Of a turn, by which a joint may move between two samples and still count as wrapped: 0.1 rad."""
PROMPT = 3.0
"""Between samples farther apart than so many usual intervals a joint may get anywhere."""


class _Leap(NamedTuple):
    row: int
    time: float
    size: float


class Leaps:
    """Count the steps between neighbouring samples that no motion explains.

    Parameters
    ----------
    units
        SI unit of each joint's position.
    row_in_file
        Gives the number that a row of the source has in the file.
    """

    def __init__(self, units: Sequence[str], row_in_file: Callable[[int], int]) -> None:
        self._units, self._row_in_file = units, row_in_file
        self._wrapped: dict[int, list[_Leap]] = {}
        self._moved: dict[int, list[_Leap]] = {}

    def update(self, stretch: Stretch) -> None:
        """Take the next stretch into account; its last step is judged with the one after it, in the next."""
        steps, waits = np.abs(np.diff(stretch.position, axis=1)), np.diff(stretch.time)
        prompt = waits < PROMPT * np.median(waits)
        prompt[: max(stretch.context - 2, 0)] = prompt[-1] = False
        for joint, own in enumerate(steps):
            far = np.flatnonzero(prompt & (own > JUMP_FACTOR * own.mean()))
            if not len(far):
                continue
            wrapped = _is_turn(own)[far]
            moved = ~wrapped & _stands_alone(own)[far]
            if moved.any():
                moved &= own[far] > JUMP_FACTOR * _usual(own)
                moved &= np.delete(_goes_on(steps), joint, axis=0)[:, far].any(axis=0)
            for found, marks in ((self._wrapped, wrapped), (self._moved, moved)):
                leaps = [
                    _Leap(stretch.first + int(at) + 1, float(stretch.time[at + 1]), float(own[at]))
                    for at in far[marks]
                ]
                found.setdefault(joint, []).extend(leaps)

    def check(self, apart: Collection[tuple[int, int]] = ()) -> None:
        """Refuse the log if a position leaps.

        Parameters
        ----------
        apart
            Rows that are cut out, from start to stop: a leap into or out of them is known.

        Raises
        ------
        LogError
            With how often each joint leaps, where first, and how far at most.
        """
        for found in (self._wrapped, self._moved):
            for leaps in found.values():
                leaps[:] = [leap for leap in leaps if not _is_within(leap.row, apart)]
        if any(self._wrapped.values()):
            raise LogError(
                "a position jumps by a whole turn from one sample to the next: the angle is wrapped",
                evidence=self._evidence(self._wrapped),
                remedy="unwrap the angles before uploading, so that they follow the joint: "
                "numpy.unwrap(angles, axis=0, period=360) for rows of degrees, period=2*numpy.pi for rad",
            )
        if any(self._moved.values()):
            raise LogError(
                "a position leaps from one sample to the next, while another joint moves on as before",
                evidence=self._evidence(self._moved),
                remedy="take the leap out of all samples behind it if the joint is counted from another zero "
                "there, or wrapped in another unit than the declared one; else send the parts as two logs",
            )

    def _evidence(self, found: dict[int, list[_Leap]]) -> dict[str, object]:
        return {
            f"joint_{joint + 1}": {
                "jumps": len(leaps),
                "first_row": self._row_in_file(leaps[0].row) + 1,
                "first_at_s": leaps[0].time,
                f"largest_{self._units[joint]}": max(leap.size for leap in leaps),
            }
            for joint, leaps in sorted(found.items())
            if leaps
        }


def _is_within(row: int, apart: Collection[tuple[int, int]]) -> bool:
    return any(start <= row <= stop for start, stop in apart)


def _usual(own: Samples) -> float:
    """Give the usual largest step of a joint, or what its resolution makes of it."""
    taken = own[own > 0.0]
    return float(max(np.quantile(taken, USUAL_SHARE), GRID_STEPS / JUMP_FACTOR * taken.min()))


def _is_turn(own: Samples) -> Mask:
    """Mark the steps of a whole turn of a joint that otherwise moves by a fraction of one."""
    marks = np.zeros(len(own), dtype=bool)
    for turn in TURNS:
        if np.median(own) < TURN_SHARE * turn:
            marks |= np.abs(own - turn) < TURN_SHARE * turn
    return marks


def _beside(own: Samples) -> tuple[Samples, Samples]:
    """Give the step before and the step after each one; past an end of the samples nothing is known."""
    return np.append(np.inf, own[:-1]), np.append(own[1:], np.inf)


def _stands_alone(own: Samples) -> Mask:
    """Mark the steps that are many times those on either side, where the joint moves on both."""
    before, after = _beside(own)
    marks: Mask = (own > JUMP_FACTOR * np.maximum(before, after)) & (np.minimum(before, after) > 0.0)
    return marks


def _goes_on(steps: Series) -> np.ndarray:
    """Mark the steps of every joint that belong to a motion which misses no row."""
    marks = [(own > MOVING * own.mean()) & (own < ON_TIME * np.minimum(*_beside(own))) for own in steps]
    return np.array(marks)
