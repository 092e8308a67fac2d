"""Test whether one channel comes in another unit than all others."""

from collections.abc import Iterator

import numpy as np

from ..conflict import Conflict, Hypothesis
from ..setup import Setup
from ..trial import Trials

_TORQUE_UNITS = {"mN m": 1e-3, "kN m": 1e3}
_POSITION_UNITS = {"deg": np.pi / 180.0, "rad though deg is declared": 180.0 / np.pi}


class Unit(Conflict):
    """Read the torque or position of one joint in another unit."""

    name = "unit"
    title = "Unit of a channel"

    def hypotheses(self, setup: Setup, _trials: Trials) -> Iterator[Hypothesis]:
        """Try the usual units, channel by channel."""
        position, torque = setup.assignment.position, setup.assignment.torque
        for joint in range(setup.joints):
            for unit, factor in _TORQUE_UNITS.items():
                yield self._of(joint, "torque", unit, setup.with_torque(torque.scaled(factor, joint)))
        for joint in setup.revolute():
            for unit, factor in _POSITION_UNITS.items():
                yield self._of(joint, "position", unit, setup.with_position(position.scaled(factor, joint)))

    def _of(self, joint: int, channel: str, unit: str, setup: Setup) -> Hypothesis:
        return Hypothesis(
            self.name,
            (joint + 1,),
            "torque" if channel == "torque" else "position",
            setup,
            f"the {channel} of joint {joint + 1} is in {unit}",
            f"declare the {channel} of joint {joint + 1} in {unit}",
        )
