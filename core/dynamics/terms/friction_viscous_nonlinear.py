"""Give nonlinear viscous friction: sign(v) |v|^p beside the linear FV v.

A power p below one is fluid friction that saturates, above one it is drag. Source: Bittencourt & Gunnarsson,
J. Dyn. Sys. Meas. Control 134(5), 2012.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...arrays import Samples
from ...robot.model import RobotModel
from ...signals.state import MotionState
from .effect import OneJointTerm, Symbol


@dataclass(frozen=True, eq=False)
class NonlinearViscous(OneJointTerm):
    """Model friction that grows with a power of speed; `exponent` without unit."""

    exponent: float
    symbols: ClassVar[tuple[Symbol, ...]] = (("coefficient", "N m (s/rad)^p", None),)
    kind: ClassVar[str] = "friction_viscous_nonlinear"

    def columns(self, robot: RobotModel, state: MotionState) -> list[Samples]:
        """Give sign(v) |v|^p."""
        del robot
        velocity = state.velocity[:, self.joint - 1]
        return [np.sign(velocity) * np.abs(velocity) ** self.exponent]
