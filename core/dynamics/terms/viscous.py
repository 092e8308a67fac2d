"""Give viscous friction: FV times joint velocity. Source: the seed paper, eq. (4)."""

from dataclasses import dataclass

from ...arrays import Samples
from ...signals.state import MotionState
from .effect import EachJointTerm


@dataclass(frozen=True)
class Viscous(EachJointTerm):
    """Model viscous friction FV."""

    name: str = "viscous"
    symbol = ("FV", "N m s/rad", 0.0)

    def column(self, joint: int, state: MotionState) -> Samples:
        """Give the joint's velocity."""
        return state.velocity[:, joint]
