"""Test whether one channel, or all positions, come in another unit than declared."""

from collections.abc import Iterator

import numpy as np

from ...arrays import JointVector
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
        """Try the usual units, of all positions and channel by channel.

        A common factor on all torques is another body's, and none that a log could show.
        """
        turning = setup.revolute()
        span = np.ptp(setup.assignment.position.of(trials.samples.position, rate=True), axis=0)
        if len(turning) > 1:
            yield from self._of_positions(setup, turning, "the positions of all joints are", span)
        for joint in range(setup.joints):
            for unit, factor in _TORQUE_UNITS.items():
                changed = setup.with_torque(setup.assignment.torque.scaled(factor, joint))
                what = f"the torque of joint {joint + 1}"
                yield Hypothesis(
                    self.name,
                    (joint + 1,),
                    "torque",
                    changed,
                    f"{what} is in {unit}",
                    f"declare {what} in {unit}",
                )
        for joint in turning:
            yield from self._of_positions(setup, (joint,), f"the position of joint {joint + 1} is", span)

    def _of_positions(
        self, setup: Setup, joints: tuple[int, ...], what: str, span: JointVector
    ) -> Iterator[Hypothesis]:
        """Try units in which joints move as joints do; expected where they do not as declared."""
        widest = float(np.max(span[list(joints)]))
        for unit, factor in _POSITION_UNITS.items():
            if UNIT.least_span <= factor * widest <= LARGEST_SPAN:
                yield Hypothesis(
                    self.name,
                    tuple(joint + 1 for joint in joints),
                    "position",
                    setup.with_position(setup.assignment.position.scaled(factor, *joints)),
                    f"{what} in {unit}",
                    f"declare {what.removesuffix(' is').removesuffix(' are')} in {unit}",
                    expected=widest > LARGEST_SPAN,
                )
