"""Test whether the channels of two joints are exchanged."""

from collections.abc import Iterator
from itertools import combinations

from ..conflict import Channel, Conflict, Hypothesis
from ..setup import Setup
from ..trial import Trials

_WORDS: dict[Channel, str] = {"torque": "torques", "position": "positions", "both": "channels"}


class ChannelsSwapped(Conflict):
    """Exchange the torques, the positions or both of two joints; neighbours come first."""

    name = "channels_swapped"
    title = "Exchanged channels"

    def hypotheses(self, setup: Setup, _trials: Trials) -> Iterator[Hypothesis]:
        """Exchange every pair."""
        pairs = sorted(combinations(range(setup.joints), 2), key=lambda pair: (pair[1] - pair[0], pair[0]))
        for first, second in pairs:
            for channel, words in _WORDS.items():
                named = f"{words} of joints {first + 1} and {second + 1}"
                yield Hypothesis(
                    self.name,
                    (first + 1, second + 1),
                    channel,
                    _exchanged(setup, channel, first, second),
                    f"the {named} are exchanged",
                    f"exchange the {named}",
                )


def _exchanged(setup: Setup, channel: Channel, first: int, second: int) -> Setup:
    if channel != "torque":
        setup = setup.with_position(setup.assignment.position.exchanged(first, second))
    if channel != "position":
        setup = setup.with_torque(setup.assignment.torque.exchanged(first, second))
    return setup
