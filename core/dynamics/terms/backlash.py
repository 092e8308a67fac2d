"""Give what play between motor and link adds: the link is left behind, then caught up with at the other side.

While motor and link touch, the link's angle differs from the motor's by the half width, on the side from
which the load presses. When the load changes its sign the link flies free until it has crossed the gap: the
twist, motor minus link, follows twist'' = load / inertia, with the load and the link's own inertia as the
rigid model predicts them. The column is the change of all loads by that twist, per unit of half width.
Source: Nordin & Gutman, Automatica 38(10), 2002.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from core.arrays import JointSeries, Samples
from core.dynamics.gear import Gear
from core.dynamics.prediction import Prediction
from core.dynamics.terms.effect import AllJointsTerm, Symbol, rates, step_of
from core.dynamics.terms.elasticity import smoothed
from core.robot.model import RobotModel
from core.signals.state import MotionState


@dataclass(frozen=True, eq=False)
class Backlash(AllJointsTerm):
    """Model play near the half width `around` (rad); the twist is smoothed at `band_hz`.

    The `motor_inertia`, kg m2, is what the believed load holds of the rotor's.
    """

    believed: Prediction
    around: float
    band_hz: float
    motor_inertia: float = 0.0
    symbols: ClassVar[tuple[Symbol, ...]] = (("half_width", "rad", 0.0),)
    kind: ClassVar[str] = "backlash"
    remembers: ClassVar[bool] = True

    def torques(self, robot: RobotModel, state: MotionState) -> list[JointSeries]:
        """Give the change of all joints' loads per rad of half width."""
        del robot
        gear = Gear(self.believed, self.joint, self.motor_inertia)
        free = gear.load(state) / np.maximum(gear.inertia(state), 1e-9)
        twist = smoothed(twist_of(free, step_of(state), self.around)[:, None], state, self.band_hz)
        lag = twist / -self.around
        return [gear.change(state, MotionState(lag, *rates(lag, state)))]


def twist_of(free: Samples, step: float, half_width: float) -> Samples:
    """Give motor minus link angle, in rad, along a motion that would tear the two apart at `free` rad/s2.

    Contacts neither bounce nor pull; the first sample lies on the side of its load.

    Examples
    --------
    >>> twist_of(np.array([1.0, 1.0, -1.0, -1.0, -1.0, -1.0]), 1.0, 1.5)
    array([ 1.5,  1.5,  1. , -0.5, -1.5, -1.5])
    """
    out = np.empty(len(free))
    pulls, back, ahead = free.tolist(), np.flatnonzero(free < 0.0), np.flatnonzero(free > 0.0)
    twist, sample = float(np.copysign(half_width, free[0])), 0
    while sample < len(free):
        turning = back if twist > 0.0 else ahead
        leaves = int(next(iter(turning[turning.searchsorted(sample) :]), len(free)))
        out[sample:leaves] = twist
        flight = _flight(pulls, leaves, twist, step, half_width)
        sample = leaves + len(flight)
        out[leaves:sample] = flight
        twist = float(out[sample - 1])
    return out


def _flight(pulls: Sequence[float], leaves: int, twist: float, step: float, half_width: float) -> list[float]:
    """Follow the twist across the gap from some sample on, until it is at a side or there is no more pull."""
    flight, rate = [], 0.0
    for sample in range(leaves, len(pulls)):
        rate += step * pulls[sample]
        twist = twist + step * rate - 0.5 * step * step * pulls[sample]
        if not -half_width <= twist <= half_width:
            flight.append(half_width if twist > 0.0 else -half_width)
            break
        flight.append(twist)
    return flight
