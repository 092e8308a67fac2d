"""Test whether a joint's zero is described a quarter turn, or several, from where it is."""

from collections.abc import Iterator

import numpy as np

from ..conflict import Conflict, Hypothesis
from ..setup import Setup
from ..trial import Trials

_DEGREES = (90, 180, -90)


class ZeroQuarterTurn(Conflict):
    """Move the zero of one revolute joint by quarter turns."""

    name = "zero_quarter_turn"
    title = "Zero off by a quarter turn"

    def hypotheses(self, setup: Setup, _trials: Trials) -> Iterator[Hypothesis]:
        """Move each zero by 90, 180 and -90 degrees."""
        channels = setup.assignment.position
        for joint in setup.revolute():
            for degrees in _DEGREES:
                yield Hypothesis(
                    self.name,
                    (joint + 1,),
                    "position",
                    setup.with_position(channels.moved(np.radians(degrees), joint)),
                    f"the zero of joint {joint + 1} is {-degrees:+d} degrees from the described one",
                    f"add {degrees:+d} degrees to the position of joint {joint + 1}",
                )
