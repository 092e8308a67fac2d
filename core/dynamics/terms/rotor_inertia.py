"""Give the torque of the rotor: its inertia at the joint, with the gear ratio squared.

The gyroscopic torque of a rotor on a rotating link is neglected, as in the seed's model. Source: Khalil &
Dombre (2002), ch. 9.
"""

from dataclasses import dataclass

from ...arrays import Samples
from ...robot.model import RobotModel
from ...signals.state import MotionState
from .effect import EachJointTerm


@dataclass(frozen=True)
class RotorInertia(EachJointTerm):
    """Model the reflected rotor inertia IA."""

    name: str = "rotor_inertia"
    symbol = ("IA", "kg m2", 0.0)

    def joints(self, robot: RobotModel) -> tuple[int, ...]:
        """List the joints (from 0) with a declared rotor."""
        return tuple(index for index, joint in enumerate(robot.joints) if joint.rotor_inertia)

    def column(self, joint: int, state: MotionState) -> Samples:
        """Give the joint's acceleration."""
        return state.acceleration[:, joint]
