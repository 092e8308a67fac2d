"""Test whether the channels of two joints are exchanged, or those of more are in another usual order."""

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from ...arrays import JointMarks
from ..conflict import Channel, Conflict, Hypothesis
from ..setup import Setup
from ..thresholds import DOUBT
from ..trial import Trials

_PAIR = 2
"""Channels that one exchange moves."""
_WORDS: dict[Channel, str] = {"torque": "torques", "position": "positions", "both": "channels"}


class ChannelsSwapped(Conflict):
    """Exchange the torques, the positions or both of two joints, neighbours first; or both of more joints."""

    name = "channels_swapped"
    title = "Exchanged channels"

    def hypotheses(self, setup: Setup, trials: Trials) -> Iterator[Hypothesis]:
        """Exchange every pair.

        The torque of a joint that stands is in no equation. Exchanged, it would be predicted in the place of
        another, and which of the two is easier to predict says nothing. So such a pair is exchanged only
        where the joint that moves is in doubt.
        """
        sound, stands = _sound(setup, trials), ~trials.moves(setup)
        for first, second in _pairs(setup.joints):
            apart = bool((stands[first] and sound[second]) or (stands[second] and sound[first]))
            yield from (self._pair(setup, channel, first, second) for channel in _channels(apart=apart))
        if setup.assignment == trials.samples.as_measured:
            yield from self._orders(setup)

    def _pair(self, setup: Setup, channel: Channel, first: int, second: int) -> Hypothesis:
        """Exchange a pair, from 0."""
        named = f"{_WORDS[channel]} of joints {first + 1} and {second + 1}"
        return Hypothesis(
            self.name,
            (first + 1, second + 1),
            channel,
            _exchanged(setup, channel, first, second),
            f"the {named} are exchanged",
            f"exchange the {named}",
        )

    def _orders(self, setup: Setup) -> Iterator[Hypothesis]:
        """Take other orders of all channels."""
        for order in _orders(setup.joints):
            columns = ", ".join(str(order.index(column) + 1) for column in range(setup.joints))
            yield Hypothesis(
                self.name,
                tuple(joint + 1 for joint, column in enumerate(order) if column != joint),
                "both",
                _ordered(setup, order),
                f"the channels come in another order: they are those of joints {columns}",
                f"map the columns {', '.join(str(column + 1) for column in order)} in this order",
            )


def _pairs(joints: int) -> list[tuple[int, int]]:
    """List pairs, from 0, neighbours first."""
    return sorted(combinations(range(joints), 2), key=lambda pair: (pair[1] - pair[0], pair[0]))


def _channels(*, apart: bool) -> tuple[Channel, ...]:
    return ("both",) if apart else tuple(_WORDS)


def _orders(joints: int) -> list[tuple[int, ...]]:
    """List orders that differ by more than one pair: backwards, and with one of them moved first or last.

    An axis that was added to an arm comes last in a controller's tables, wherever it stands in the arm. An
    order gives the column of every joint, from 0.
    """
    usual = tuple(range(joints))
    orders = [usual[::-1]]
    for joint in usual:
        others = usual[:joint] + usual[joint + 1 :]
        for place in (0, joints - 1):
            order = (*others[:place], joint, *others[place:])
            orders += [order, tuple(order.index(column) for column in usual)]
    return [order for order in dict.fromkeys(orders) if _differing(order) > _PAIR]


def _differing(order: tuple[int, ...]) -> int:
    return sum(column != joint for joint, column in enumerate(order))


def _ordered(setup: Setup, order: tuple[int, ...]) -> Setup:
    """Take for every joint the channels of another."""
    own = setup.assignment
    setup = setup.with_position(own.position.in_order(order))
    return setup.with_torque(own.torque.in_order(order))


def _sound(setup: Setup, trials: Trials) -> JointMarks:
    """Mark the joints that move and are predicted as they should be."""
    moves, present = trials.moves(setup), None
    if not moves.all():
        present = trials.outcome(setup)
    return moves & (present.errors < DOUBT.unexplained) if present is not None else np.zeros_like(moves)


def _exchanged(setup: Setup, channel: Channel, first: int, second: int) -> Setup:
    if channel != "torque":
        setup = setup.with_position(setup.assignment.position.exchanged(first, second))
    if channel != "position":
        setup = setup.with_torque(setup.assignment.torque.exchanged(first, second))
    return setup
