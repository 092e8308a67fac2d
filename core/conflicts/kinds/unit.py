"""Test whether one channel, or all angles, come in another unit than declared."""

from collections.abc import Iterator, Mapping

import numpy as np

from ...log.channels import POSITIONS, TORQUES
from ...robot.joint_units import joint_unit
from ..conflict import Conflict, Hypothesis
from ..setup import Setup
from ..thresholds import UNIT
from ..trial import Trials

_PREFIXES = {"m": 1e-3, "k": 1e3}
_ANGLES = {"deg": np.pi / 180.0, "rad though deg is declared": 180.0 / np.pi}
_STROKES = {"mm": 1e-3, "m though mm is declared": 1e3}


class Unit(Conflict):
    """Read the effort or position of one joint, or the positions of all revolute joints, in another unit."""

    name = "unit"
    title = "Unit of a channel"

    def hypotheses(self, setup: Setup, trials: Trials) -> Iterator[Hypothesis]:
        """Try the usual units, of all angles and channel by channel.

        A common factor on all torques is another body's, and none that a log could show.
        """
        turning = setup.revolute()
        if len(turning) > 1:
            yield from self._of_positions(setup, trials, turning, "the positions of all joints are")
        for joint in range(setup.joints):
            yield from self._of_effort(setup, trials, joint)
        for joint in range(setup.joints):
            yield from self._of_positions(setup, trials, (joint,), f"the position of joint {joint + 1} is")

    def _of_effort(self, setup: Setup, trials: Trials, joint: int) -> Iterator[Hypothesis]:
        """Try units in which a torque is as large as torques are; expected where it is not as declared."""
        what, torque = f"the torque of joint {joint + 1}", setup.assignment.torque
        declared = joint_unit(setup.robot, joint + 1, "N m")
        largest = float(np.max(np.abs(torque.of(trials.samples.torque)[:, joint])))
        most = next(unit.usual[1] for unit in TORQUES.units if unit.name == declared)
        for prefix, factor in _PREFIXES.items():
            if factor < 1.0 or factor * largest <= most:
                yield Hypothesis(
                    self.name,
                    (joint + 1,),
                    "torque",
                    setup.with_torque(torque.scaled(factor, joint)),
                    f"{what} is in {prefix}{declared}",
                    f"declare {what} in {prefix}{declared}",
                    expected=largest > most,
                )

    def _of_positions(
        self, setup: Setup, trials: Trials, joints: tuple[int, ...], what: str
    ) -> Iterator[Hypothesis]:
        """Try units in which joints move as joints do; expected where they do not as declared."""
        position = setup.assignment.position
        span = float(np.max(np.ptp(position.of(trials.samples.position), axis=0)[list(joints)]))
        units, least, most = _units(setup, joints)
        for unit, factor in units.items():
            if least <= factor * span <= most:
                yield Hypothesis(
                    self.name,
                    tuple(joint + 1 for joint in joints),
                    "position",
                    setup.with_position(position.scaled(factor, *joints)),
                    f"{what} in {unit}",
                    f"declare {what.removesuffix(' is').removesuffix(' are')} in {unit}",
                    expected=span > most,
                )


def _units(setup: Setup, joints: tuple[int, ...]) -> tuple[Mapping[str, float], float, float]:
    """Give the units of joints of one kind, and how far such a joint moves at least and at most, rad or m."""
    usual = {unit.name: unit.usual for unit in POSITIONS.units}
    if set(joints) <= set(setup.revolute()):
        return _ANGLES, UNIT.least_span, usual["rad"][1]
    return _STROKES, *usual["m"]
