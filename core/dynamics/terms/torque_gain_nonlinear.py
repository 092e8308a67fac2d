"""Give the effect of a torque constant that varies with current on a channel: the predicted torque cubed.

Where the channel reads tau + c tau^3, with tau the whole torque of the joint, the column is tau^3. A motor in
magnetic saturation needs more current, and c is positive. Source: the first odd term beyond a constant
gain; Gautier & Briot 2011 on drive gains.
"""

from dataclasses import dataclass

from ...arrays import Samples
from ...signals.state import MotionState
from ..prediction import Prediction
from .effect import OneJointTerm


@dataclass(frozen=True, eq=False)
class CubicGain(OneJointTerm):
    """Model a channel whose gain changes with the square of the torque."""

    believed: Prediction
    symbols = (("cubic_coefficient", "1/(N m)^2", None),)
    kind = "torque_gain_nonlinear"
    channel = True

    def columns(self, state: MotionState) -> list[Samples]:
        """Give the predicted torque cubed."""
        return [self.believed.applied(state)[:, self.joint - 1] ** 3]
