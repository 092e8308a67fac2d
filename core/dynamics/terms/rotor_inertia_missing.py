"""Give the torque of an undeclared rotor: proportional to the joint's own acceleration.

Source: Khalil & Dombre, Modeling, Identification and Control of Robots (2002), ch. 9.
"""

from dataclasses import dataclass

from ...arrays import Samples
from ...signals.state import MotionState
from .effect import OneJointTerm


@dataclass(frozen=True, eq=False)
class MissingRotor(OneJointTerm):
    """Model the reflected inertia of one rotor."""

    symbols = (("IA", "kg m2", 0.0),)
    kind = "rotor_inertia_missing"

    def columns(self, state: MotionState) -> list[Samples]:
        """Give the acceleration."""
        return [state.acceleration[:, self.joint - 1].copy()]
