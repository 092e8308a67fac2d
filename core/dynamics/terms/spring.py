"""Give the torque that a spring beside the motor takes: the joint's angle times its stiffness.

Where it rests is an offset, which the model has already; so what a gear transmits of it, where it acts behind
one, is known up to a constant only, and it is not counted among the loads. Source: Klimchik, Pashkevich et
al. 2013 (counterbalances).
"""

from dataclasses import dataclass
from typing import ClassVar

from ...arrays import Samples
from ...robot.model import RobotModel
from ...signals.state import MotionState
from .effect import OneJointTerm, Symbol


@dataclass(frozen=True, eq=False)
class Spring(OneJointTerm):
    """Model a spring about the joint's axis that pulls against its angle."""

    symbols: ClassVar[tuple[Symbol, ...]] = (("stiffness", "N m/rad", None),)
    kind: ClassVar[str] = "spring_compensator"

    def columns(self, robot: RobotModel, state: MotionState) -> list[Samples]:
        """Give q."""
        del robot
        return [state.position[:, self.joint - 1].copy()]
