"""Give the torque of a spring parallel to the motor: stiffness times the joint's angle.

Its rest angle is an offset, which the model has already. Behind a transmission its load is known up to a
constant only, so that it is not counted among the loads. Source: Klimchik, Pashkevich et
al. 2013 (counterbalances).
"""

from dataclasses import dataclass

from ...arrays import Samples
from ...signals.state import MotionState
from .effect import OneJointTerm


@dataclass(frozen=True, eq=False)
class Spring(OneJointTerm):
    """Model a spring about the joint's axis that pulls against its angle."""

    symbols = (("stiffness", "N m/rad", None),)
    kind = "spring_compensator"

    def columns(self, state: MotionState) -> list[Samples]:
        """Give q."""
        return [state.position[:, self.joint - 1].copy()]
