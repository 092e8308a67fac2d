"""Test whether a joint's motion is counted in the opposite direction to its described axis."""

from collections.abc import Iterator

from ..conflict import Conflict, Hypothesis
from ..setup import Setup
from ..trial import Trials


class PositionSign(Conflict):
    """Reverse one position, with or without its torque, or all of them.

    To reverse all positions and all torques is to mirror the robot, which turns gravity round.
    """

    name = "position_sign"
    title = "Sign of a position"

    def hypotheses(self, setup: Setup, _trials: Trials) -> Iterator[Hypothesis]:
        """Reverse each position, each joint's axis, and all positions together."""
        position, torque = setup.assignment.position, setup.assignment.torque
        for joint in range(setup.joints):
            other = setup.with_position(position.scaled(-1.0, joint))
            yield Hypothesis(
                self.name,
                (joint + 1,),
                "position",
                other,
                f"the position of joint {joint + 1} has the opposite sign",
                f"reverse the sign of the position of joint {joint + 1}",
            )
            yield Hypothesis(
                self.name,
                (joint + 1,),
                "both",
                other.with_torque(torque.scaled(-1.0, joint)),
                f"position and torque of joint {joint + 1} are counted against the described axis",
                f"reverse the signs of position and torque of joint {joint + 1}",
            )
        if setup.joints > 1:
            yield Hypothesis(
                self.name,
                tuple(range(1, setup.joints + 1)),
                "position",
                setup.with_position(position.scaled(-1.0, *range(setup.joints))),
                "all positions have the opposite sign",
                "reverse the sign of all positions",
            )
