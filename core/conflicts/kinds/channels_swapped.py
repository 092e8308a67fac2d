"""Test whether the channels of two joints are exchanged."""

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from ...arrays import JointMarks
from ..conflict import Channel, Conflict, Hypothesis
from ..setup import Setup
from ..thresholds import DOUBT
from ..trial import Trials

_WORDS: dict[Channel, str] = {"torque": "torques", "position": "positions", "both": "channels"}


class ChannelsSwapped(Conflict):
    """Exchange the torques, the positions or both of two joints; neighbours come first."""

    name = "channels_swapped"
    title = "Exchanged channels"

    def hypotheses(self, setup: Setup, trials: Trials) -> Iterator[Hypothesis]:
        """Exchange every pair.

        The torque of a joint that stands is in no equation. Exchanged, it would be predicted in the place of
        another, and which of the two is easier to predict says nothing. So such a pair is exchanged only
        where the joint that moves is in doubt.
        """
        pairs = sorted(combinations(range(setup.joints), 2), key=lambda pair: (pair[1] - pair[0], pair[0]))
        sound, stands = _sound(setup, trials), ~trials.moves(setup)
        for first, second in pairs:
            apart = bool((stands[first] and sound[second]) or (stands[second] and sound[first]))
            for channel, words in _WORDS.items():
                if apart and channel != "both":
                    continue
                named = f"{words} of joints {first + 1} and {second + 1}"
                yield Hypothesis(
                    self.name,
                    (first + 1, second + 1),
                    channel,
                    _exchanged(setup, channel, first, second),
                    f"the {named} are exchanged",
                    f"exchange the {named}",
                )


def _sound(setup: Setup, trials: Trials) -> JointMarks:
    """Mark the joints that move and are predicted as they should be."""
    moves, present = trials.moves(setup), None
    if not moves.all():
        present = trials.outcome(trials.equations(setup))
    return moves & (present.errors < DOUBT.unexplained) if present is not None else np.zeros_like(moves)


def _exchanged(setup: Setup, channel: Channel, first: int, second: int) -> Setup:
    if channel != "torque":
        setup = setup.with_position(setup.assignment.position.exchanged(first, second))
    if channel != "position":
        setup = setup.with_torque(setup.assignment.torque.exchanged(first, second))
    return setup
