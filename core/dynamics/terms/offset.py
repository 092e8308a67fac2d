"""Give the constant torque offset: amplifier offset and asymmetric Coulomb friction, which are not separable.

Source: the seed paper, eq. (4).
"""

from dataclasses import dataclass

from ...signals.state import MotionState
from .effect import EachJointTerm


@dataclass(frozen=True)
class Offset(EachJointTerm):
    """Model the torque offset OFF."""

    name: str = "offset"
    symbol = ("OFF", "N m", None)

    def column(self, joint: int, state: MotionState) -> float:
        """Give one."""
        del joint, state
        return 1.0
