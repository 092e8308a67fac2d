"""Test whether a position is that of a link, counted from the horizontal, and not the joint's own."""

from collections.abc import Iterator

from ..conflict import Conflict, Hypothesis
from ..setup import Setup
from ..thresholds import LINKAGE
from ..trial import Trials


class PositionLinkage(Conflict):
    """Add or subtract the position of the joint before, where both turn about parallel axes."""

    name = "position_linkage"
    title = "Position of a link, not of a joint"

    def hypotheses(self, setup: Setup, trials: Trials) -> Iterator[Hypothesis]:
        """Try both signs for each joint whose link is carried by one that turns about a parallel axis."""
        moves = trials.moves(setup)
        for other, joint in _about_parallel_axes(setup):
            if moves[other]:
                yield self._linked(setup, joint, other, 1.0, ("less", "add {} to {}"))
                yield self._linked(setup, joint, other, -1.0, ("plus", "subtract {} from {}"))

    def _linked(
        self, setup: Setup, joint: int, other: int, factor: float, words: tuple[str, str]
    ) -> Hypothesis:
        """Add the position of another joint, times a factor."""
        logged, remedy = words
        theirs, own = (f"the position of joint {one + 1}" for one in (other, joint))
        return Hypothesis(
            self.name,
            (joint + 1,),
            "position",
            setup.with_position(setup.assignment.position.with_added(factor, other, joint)),
            f"{own} is its angle {logged} that of joint {other + 1}, as where a controller counts the "
            "angle of a link from the horizontal",
            remedy.format(theirs, own),
        )


def _about_parallel_axes(setup: Setup) -> list[tuple[int, int]]:
    """List the pairs of a joint and the one that its link carries, from 0, that turn about parallel axes."""
    links, turning = setup.robot.links, setup.revolute()
    carried = [link for link in links if link.antecedent and abs(link.rotation[2, 2]) > LINKAGE.parallel]
    pairs = [(links[link.antecedent - 1].joint - 1, link.joint - 1) for link in carried]
    return [pair for pair in pairs if {*pair} <= {*turning} and len({*pair}) > 1]
