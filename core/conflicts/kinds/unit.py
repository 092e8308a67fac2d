"""Test whether one channel, or all positions, come in another unit than declared."""

from collections.abc import Iterator

import numpy as np

from ...log.defects.plausibility import LARGEST_SPAN
from ..conflict import Conflict, Hypothesis
from ..setup import Setup
from ..thresholds import UNIT
from ..trial import Trials

_TORQUE_UNITS = {"mN m": 1e-3, "kN m": 1e3}
_POSITION_UNITS = {"deg": np.pi / 180.0, "rad though deg is declared": 180.0 / np.pi}


class Unit(Conflict):
    """Read the torque or position of one joint, or the positions of all, in another unit."""

    name = "unit"
    title = "Unit of a channel"

    def hypotheses(self, setup: Setup, trials: Trials) -> Iterator[Hypothesis]:
        """Try the usual units, of all positions and channel by channel, in which a joint moves as joints do.

        A common factor on all torques is another body's, and none that a log could show.
        """
        position, torque = setup.assignment.position, setup.assignment.torque
        turning = setup.revolute()
        span = np.ptp(position.of(trials.samples.position, rate=True), axis=0)
        expected = {joint for joint in turning if span[joint] > LARGEST_SPAN}
        for unit, factor in _POSITION_UNITS.items() if len(turning) > 1 else ():
            if UNIT.least_span <= factor * np.max(span[list(turning)]) <= LARGEST_SPAN:
                yield Hypothesis(
                    self.name,
                    tuple(joint + 1 for joint in turning),
                    "position",
                    setup.with_position(position.scaled(factor, *turning)),
                    f"the positions of all joints are in {unit}",
                    f"declare all positions in {unit}",
                    expected=bool(expected),
                )
        for joint in range(setup.joints):
            for unit, factor in _TORQUE_UNITS.items():
                yield self._of(joint, "torque", unit, setup.with_torque(torque.scaled(factor, joint)))
        for joint in turning:
            for unit, factor in _POSITION_UNITS.items():
                if UNIT.least_span <= factor * span[joint] <= LARGEST_SPAN:
                    changed = setup.with_position(position.scaled(factor, joint))
                    yield self._of(joint, "position", unit, changed, expected=joint in expected)

    def _of(self, joint: int, channel: str, unit: str, setup: Setup, *, expected: bool = False) -> Hypothesis:
        return Hypothesis(
            self.name,
            (joint + 1,),
            "torque" if channel == "torque" else "position",
            setup,
            f"the {channel} of joint {joint + 1} is in {unit}",
            f"declare the {channel} of joint {joint + 1} in {unit}",
            expected,
        )
