"""Find joints whose torque or current has no sign: a drive's magnitude, such as its RMS current.

Where a load changes its direction, a magnitude comes down to zero and turns. A signed torque that has one
sign all the time hardly comes as near to zero again and again without ever passing it.
"""

import numpy as np

from ..model import Defect
from .stretch import Facts, Stretch

UNSIGNED = "unsigned_torque"
NEAR = 0.03
"""Share of the channel's deviation within which it is at zero."""
FAR = 0.3
"""Share beyond which it has left zero."""
LEAST_VISITS = 5
"""How often it comes from far to zero at least. Set by hand: once or twice is chance."""


class Unsigned:
    """Count how often every joint's torque or current comes to zero, and whether it has both signs."""

    def __init__(self, joints: int) -> None:
        self._visits = np.zeros(joints, dtype=int)
        self._channel = ""

    def update(self, stretch: Stretch) -> None:
        """Take the next stretch into account."""
        self._channel = stretch.effort
        for joint, values in enumerate(stretch.new()[self._channel]):
            size, deviation = np.abs(values), float(np.std(values))
            near, far = size < NEAR * deviation, size > FAR * deviation
            at_zero = near[near | far]
            self._visits[joint] += np.count_nonzero(at_zero[1:] & ~at_zero[:-1])

    def defects(self, facts: Facts) -> list[Defect]:
        """State the joints that come to zero often and never pass it."""
        channel = self._channel
        one_sign = (facts.low[channel] >= 0.0) | (facts.high[channel] <= 0.0)
        return [
            Defect(
                UNSIGNED,
                channel,
                joint + 1,
                int(self._visits[joint]),
                (),
                f"The {channel} of joint {joint + 1} comes to zero {self._visits[joint]} times and never "
                "changes its sign: it is a magnitude, or one sign is cut off. Map the signed channel, "
                "or leave this one out by a scale of 0.",
            )
            for joint in map(int, np.flatnonzero(one_sign & (self._visits >= LEAST_VISITS)))
            if facts.travels(joint)
        ]
