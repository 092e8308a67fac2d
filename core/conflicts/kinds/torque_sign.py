"""Test whether a torque is counted in the opposite direction to its joint's motion."""

from collections.abc import Iterator

from ..conflict import Conflict, Hypothesis
from ..setup import Setup
from ..trial import Trials


class TorqueSign(Conflict):
    """Reverse one torque, or all of them."""

    name = "torque_sign"
    title = "Sign of a torque"

    def hypotheses(self, setup: Setup, _trials: Trials) -> Iterator[Hypothesis]:
        """Reverse each torque, and all together."""
        channels = setup.assignment.torque
        for joint in range(setup.joints):
            yield Hypothesis(
                self.name,
                (joint + 1,),
                "torque",
                setup.with_torque(channels.scaled(-1.0, joint)),
                f"the torque of joint {joint + 1} has the opposite sign",
                f"reverse the sign of the torque of joint {joint + 1}",
            )
        if setup.joints > 1:
            yield Hypothesis(
                self.name,
                tuple(range(1, setup.joints + 1)),
                "torque",
                setup.with_torque(channels.scaled(-1.0, *range(setup.joints))),
                "all torques have the opposite sign",
                "reverse the sign of all torques",
            )
