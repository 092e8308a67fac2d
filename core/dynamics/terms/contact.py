"""Give what something that pushes against a link adds while it pushes: minus J(q)'F in a window of time.

The force is constant in the base frame and acts on the robot at the origin of the link's frame; what helps
the drives is missing from their torque. Source: De Luca & Mattone, ICRA 2005; Khalil & Dombre (2002), ch. 5.
"""

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import ClassVar

import numpy as np

from core.arrays import JointSeries
from core.dynamics.newton_euler import inverse_dynamics
from core.dynamics.terms.effect import AllJointsTerm, Symbol
from core.robot.model import RobotModel
from core.signals.state import MotionState


@dataclass(frozen=True, eq=False)
class Contact(AllJointsTerm):
    """Model a force on a link (number from 1) from `begin` on for `length`, both in s."""

    link: int
    begin: float
    length: float
    symbols: ClassVar[tuple[Symbol, ...]] = tuple((f"force_{axis}", "N", None) for axis in "xyz")
    kind: ClassVar[str] = "external_contact"

    def torques(self, robot: RobotModel, state: MotionState) -> list[JointSeries]:
        """Give the torque per newton along the base's axes while there is contact."""
        columns = push_torques(robot, self.link, state)
        if state.time is None:
            return list(columns)
        inside = (state.time >= self.begin) & (state.time < self.begin + self.length)
        return list(columns * inside[:, None])


@lru_cache(maxsize=8)
def push_torques(robot: RobotModel, link: int, state: MotionState) -> np.ndarray:
    """Give what the drives need more per newton on a link's frame: 3 x samples x joints.

    A force F in the base frame on the origin of the link's frame puts J'F on the joints, so that the drives
    need -J'F more. That is the weight of a kilogram there under a gravity of F, with the posture at rest.
    """
    still = np.zeros_like(state.velocity)
    rest = replace(state, velocity=still, acceleration=still)
    bodies = np.zeros((len(robot.links), 10))
    bodies[link - 1, 9] = 1.0
    torques = np.array([inverse_dynamics(replace(robot, gravity=axis), bodies, rest) for axis in np.eye(3)])
    torques.setflags(write=False)
    return torques
