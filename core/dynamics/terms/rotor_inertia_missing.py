"""Give the torque of an undeclared rotor: proportional to the joint's own acceleration.

Source: Khalil & Dombre, Modeling, Identification and Control of Robots (2002), ch. 9.
"""

from dataclasses import dataclass
from typing import ClassVar

from ...arrays import Samples
from ...robot.model import RobotModel
from ...signals.state import MotionState
from .effect import OneJointTerm, Symbol


@dataclass(frozen=True, eq=False)
class MissingRotor(OneJointTerm):
    """Model the reflected inertia of one rotor."""

    symbols: ClassVar[tuple[Symbol, ...]] = (("IA", "kg m2", 0.0),)
    kind: ClassVar[str] = "rotor_inertia_missing"

    def columns(self, robot: RobotModel, state: MotionState) -> list[Samples]:
        """Give the acceleration."""
        del robot
        return [state.acceleration[:, self.joint - 1].copy()]
