"""Suspect that a joint's motion is counted in the opposite direction to its described axis."""

from collections.abc import Iterator

from ..conflict import Conflict, Hypothesis
from ..setup import Setup
from ..trial import Trials


class PositionSign(Conflict):
    """Reverse one position, with or without its torque, or all of them."""

    name = "position_sign"
    title = "Sign of a position"

    def hypotheses(self, setup: Setup, trials: Trials) -> Iterator[Hypothesis]:  # noqa: ARG002 - as all do
        """Reverse each position, each joint's axis, and all positions together."""
        position, torque = setup.assignment.position, setup.assignment.torque
        every = tuple(range(setup.joints))
        for joints in [*((joint,) for joint in every), *([every] if len(every) > 1 else [])]:
            named = "all joints" if len(joints) > 1 else f"joint {joints[0] + 1}"
            reversed_ = setup.with_position(position.scaled(-1.0, *joints))
            numbers = tuple(joint + 1 for joint in joints)
            yield Hypothesis(
                self.name,
                numbers,
                "position",
                reversed_,
                f"the position of {named} has the opposite sign",
                f"reverse the sign of the position of {named}",
            )
            yield Hypothesis(
                self.name,
                numbers,
                "both",
                reversed_.with_torque(torque.scaled(-1.0, *joints)),
                f"position and torque of {named} are counted against the described axis",
                f"reverse the signs of position and torque of {named}",
            )
