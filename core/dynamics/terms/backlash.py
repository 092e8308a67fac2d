"""Give the effect of backlash between motor and link on all loads.

In contact, the link's angle differs from the motor's by the half width, on the side that the load selects.
When the load changes its sign the link moves freely until it has crossed the gap: the twist, motor minus
link, follows twist'' = load / inertia, with load and link inertia as the rigid model predicts them. The
column is the change of all loads by that twist, per unit of half width.
Source: Nordin & Gutman, Automatica 38(10), 2002.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...arrays import JointSeries, Samples
from ...numerics.following import move_between_stops
from ...robot.model import RobotModel
from ...signals.state import MotionState
from ..gear import Gear
from ..prediction import Prediction
from .effect import AllJointsTerm, step_of
from .joint_elasticity import smooth


@dataclass(frozen=True, eq=False)
class Backlash(AllJointsTerm):
    """Model backlash near the half width `around` (rad); the twist is smoothed at `band_hz`.

    The `motor_inertia`, kg m2, is the rotor inertia that the operating point's load contains.
    """

    believed: Prediction
    around: float
    band_hz: float
    motor_inertia: float = 0.0
    symbols = (("half_width", "rad", 0.0),)
    kind = "backlash"
    has_memory = True

    def torques(self, robot: RobotModel, state: MotionState) -> list[JointSeries]:
        """Give the change of all joints' loads per rad of half width."""
        del robot
        gear = Gear(self.believed, self.joint, self.motor_inertia)
        twist = twist_of(_free(gear, state), step_of(state), self.around)
        lag = smooth(twist[:, None], state, self.band_hz)[:, 0] / -self.around
        return [gear.displaced(state, lag)]


@lru_cache(maxsize=64)
def _free(gear: Gear, state: MotionState) -> Samples:
    """Give how the motor leaves a link that it does not touch, rad/s2 (m/s2); cached for a scan."""
    return np.asarray(gear.load(state) / np.maximum(gear.inertia(state), 1e-9))


def twist_of(free: Samples, step: float, half_width: float) -> Samples:
    """Give motor minus link angle, in rad, along a motion that separates them at `free` rad/s2.

    Contacts neither bounce nor pull; the first sample lies on the side of its load.

    Examples
    --------
    >>> twist_of(np.array([1.0, 1.0, -1.0, -1.0, -1.0, -1.0]), 1.0, 1.5)
    array([ 1.5,  1.5,  1. , -0.5, -1.5, -1.5])
    """
    twist = np.empty(len(free))
    move_between_stops(np.array(free), step, half_width, twist)
    return twist
