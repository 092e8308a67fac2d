"""Find joints whose torque or current has no sign: a drive's magnitude, such as its RMS current.

Where a load changes its direction, a magnitude comes down to zero and turns. A signed torque that has one
sign all the time hardly comes as near to zero again and again without ever passing it. The same is true of
a magnitude that was given the sign of the speed, once it is multiplied by that sign where the joint moves.

A load that never comes near zero shows nothing of this. So beside such a joint the others, which the same
recorder logged, may be magnitudes as well, but for those whose torque has both signs in either direction.
"""

import numpy as np

from ...arrays import Samples
from ..model import Defect
from .stretch import Facts, Stretch

UNSIGNED, UNKNOWN_SIGN = "unsigned_torque", "unknown_sign"
NEAR = 0.03
"""Share of the channel's deviation within which it is at zero."""
FAR = 0.3
"""Share beyond which it has left zero; of a joint's travel, beyond which it moves clearly."""
LEAST_VISITS = 5
"""How often it comes from far to zero at least. Set by hand: once or twice is chance."""
REACH_ROWS = 5
"""Rows before and after a row between which its direction is taken, where the joint travels `FAR` there."""


class Unsigned:
    """Count how often every joint's torque or current comes to zero, and whether it has both signs."""

    def __init__(self, joints: int) -> None:
        self._visits, self._along = np.zeros(joints, dtype=int), np.zeros(joints, dtype=int)
        self._follows = np.ones(joints, dtype=bool)
        self._signs = np.zeros((joints, 2, 2), dtype=bool)
        """By joint, direction and sign, whether its torque clearly has that sign while it moves so."""
        self._channel = ""

    def update(self, stretch: Stretch) -> None:
        """Take the next stretch into account."""
        self._channel, new = stretch.effort, stretch.new()
        for joint, (values, position) in enumerate(zip(new[self._channel], new["position"], strict=True)):
            deviation = float(np.std(values))
            self._visits[joint] += _count_visits(values, deviation)
            direction = _direction(position)
            along = (direction * values)[direction != 0.0]
            self._along[joint] += _count_visits(along, deviation)
            self._follows[joint] &= bool(np.all(along >= 0.0))
            self._signs[joint] |= _signs(direction, values, FAR * deviation)

    def defects(self, facts: Facts) -> list[Defect]:
        """State the joints that come to zero often and never pass it, by themselves or along the speed."""
        low, high = facts.low[self._channel], facts.high[self._channel]
        found = []
        for joint, one_sign in enumerate((low >= 0.0) | (high <= 0.0)):
            visits = (self._visits if one_sign else self._along * self._follows)[joint]
            if visits < LEAST_VISITS or not facts.travels(joint):
                continue
            says = (
                "never changes its sign: it is a magnitude, or one sign is cut off"
                if one_sign
                else "never passes it while the joint moves: it is a magnitude with the sign of the speed"
            )
            statement = (
                f"The {self._channel} of joint {joint + 1} comes to zero {visits} times and {says}. "
                "Map the signed channel, or leave this one out by a scale of 0."
            )
            found.append(Defect(UNSIGNED, self._channel, joint + 1, int(visits), (), statement))
        return [*found, *self._unknown(facts, {defect.joint for defect in found})] if found else []

    def _unknown(self, facts: Facts, unsigned: set[int | None]) -> list[Defect]:
        """State the other joints that move, and whose torque is not shown to have a sign of its own."""
        varies = facts.span(self._channel) > 0.0
        shown = [_is_signed(signs) for signs in self._signs]
        return [
            Defect(
                UNKNOWN_SIGN,
                self._channel,
                joint + 1,
                facts.samples,
                (),
                f"The {self._channel} of joint {joint + 1} never has both signs in one direction of motion. "
                "As other joints' are magnitudes, it may be one as well: map the signed channel.",
            )
            for joint in map(int, np.flatnonzero(varies & ~np.array(shown)))
            if joint + 1 not in unsigned and facts.travels(joint)
        ]


def _count_visits(values: Samples, deviation: float) -> int:
    """Count how often values come from far to zero."""
    size = np.abs(values)
    near, far = size < NEAR * deviation, size > FAR * deviation
    at_zero = near[near | far]
    return int(np.count_nonzero(at_zero[1:] & ~at_zero[:-1]))


def _direction(position: Samples) -> Samples:
    """Give the sign of the speed where a joint moves clearly, and 0 elsewhere."""
    travel = np.zeros(len(position))
    travel[REACH_ROWS:-REACH_ROWS] = position[2 * REACH_ROWS :] - position[: -2 * REACH_ROWS]
    return np.asarray(np.where(np.abs(travel) > FAR * np.std(travel), np.sign(travel), 0.0))


def _signs(direction: Samples, values: Samples, clear: float) -> np.ndarray:
    """Tell, by direction and sign, whether values are clearly so, on average over some rows.

    Where a speed is noisy, single rows of a magnitude have its wrong sign.
    """
    window = np.full(2 * REACH_ROWS + 1, 1.0 / (2 * REACH_ROWS + 1))
    level = np.convolve(values, window, mode="same")
    return np.array(
        [[bool(np.any(sign * level[direction == way] > clear)) for sign in (1, -1)] for way in (1, -1)]
    )


def _is_signed(signs: np.ndarray) -> bool:
    """Tell whether a torque has both signs in one direction: no magnitude has, given a sign or not."""
    return bool(signs.all(axis=1).any())
