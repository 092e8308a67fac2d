"""Give the torque of the rotor: its inertia at the joint, with the gear ratio squared.

The gyroscopic torque of a rotor on a rotating link is neglected, as in the seed's model. Source: Khalil &
Dombre (2002), ch. 9.
"""

from dataclasses import dataclass
from typing import ClassVar

from ...arrays import Series
from ...robot.model import RobotModel
from ...robot.parameters import Parameter
from ...signals.state import MotionState
from ..term import Entry
from .effect import own_joint_entries, own_joint_parameters, own_joint_series


@dataclass(frozen=True)
class RotorInertia:
    """Model the reflected rotor inertia IA."""

    name: str = "rotor_inertia"
    remembers: ClassVar[bool] = False
    channel: ClassVar[bool] = False
    loads: ClassVar[bool] = False

    def parameters(self, robot: RobotModel) -> tuple[Parameter, ...]:
        """List IA of every joint that has it."""
        return own_joint_parameters(robot, _joints(robot), "IA", "kg m2", 0.0)

    def entries(self, robot: RobotModel) -> tuple[Entry, ...]:
        """Pair each joint with its own parameter."""
        return own_joint_entries(_joints(robot))

    def series(self, robot: RobotModel, state: MotionState) -> Series:
        """Give the torque per unit parameter."""
        return own_joint_series(
            _joints(robot), len(state.position), lambda joint: state.acceleration[:, joint]
        )


def _joints(robot: RobotModel) -> tuple[int, ...]:
    return tuple(index for index, joint in enumerate(robot.joints) if joint.rotor_inertia)
