"""Refuse positions that leap, as of a joint that is counted on from another zero.

A motion of limited bandwidth, sampled well, steps from row to row much as it did just before. A step that is
many times the steps on either side, and all usual ones, is no motion of that joint. Rows that a recorder has
missed look alike, but then every moving joint is farther on at once; a position that was held, or is, belongs
to a channel that hangs. Steps of whole turns are not among them (see `turns`).
"""

from collections.abc import Callable, Collection, Sequence
from typing import NamedTuple

import numpy as np

from ...arrays import Mask, Samples, Series
from ...errors import LogError
from .stretch import JUMP_FACTOR, Stretch, usual_step

MOVING = 0.1
"""A joint moves that steps by this share of its mean step."""
ON_TIME = 2.0
"""A moving joint that steps by less than so many times its steps on either side has missed no row."""
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
        self._found: dict[int, list[_Leap]] = {}

    def update(self, stretch: Stretch) -> None:
        """Take the next stretch into account; its last step is judged with the one after it, in the next."""
        steps, waits = np.abs(np.diff(stretch.position, axis=1)), np.diff(stretch.time)
        prompt = waits < PROMPT * np.median(waits)
        prompt[: max(stretch.context - 2, 0)] = prompt[-1] = False
        for joint, own in enumerate(steps):
            far = np.flatnonzero(prompt & (own > JUMP_FACTOR * own.mean()))
            if not len(far):
                continue
            moved = _stands_alone(own)[far]
            if moved.any():
                moved &= own[far] > JUMP_FACTOR * usual_step(own)
                moved &= np.delete(_goes_on(steps), joint, axis=0)[:, far].any(axis=0)
            self._found.setdefault(joint, []).extend(
                _Leap(stretch.first + int(at) + 1, float(stretch.time[at + 1]), float(own[at]))
                for at in far[moved]
            )

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
        for leaps in self._found.values():
            leaps[:] = [leap for leap in leaps if not _is_within(leap.row, apart)]
        if any(self._found.values()):
            raise LogError(
                "a position leaps from one sample to the next, while another joint moves on as before",
                evidence=self._evidence(),
                remedy="take the leap out of all samples behind it if the joint is counted from another zero "
                "there, or wrapped in another unit than the declared one; else send the parts as two logs",
            )

    def _evidence(self) -> dict[str, object]:
        return {
            f"joint_{joint + 1}": {
                "jumps": len(leaps),
                "first_row": self._row_in_file(leaps[0].row) + 1,
                "first_at_s": leaps[0].time,
                f"largest_{self._units[joint]}": max(leap.size for leap in leaps),
            }
            for joint, leaps in sorted(self._found.items())
            if leaps
        }


def _is_within(row: int, apart: Collection[tuple[int, int]]) -> bool:
    return any(start <= row <= stop for start, stop in apart)


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
