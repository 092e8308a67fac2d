"""Give direction-dependent viscous friction: |v| times half the difference.

FV + delta forwards and FV - delta backwards is FV v + delta |v|. Source: Armstrong-Helouvry, Control of
Machines with Friction (1991).
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...arrays import Samples
from ...robot.model import RobotModel
from ...signals.state import MotionState
from .effect import OneJointTerm, Symbol


@dataclass(frozen=True, eq=False)
class AsymmetricViscous(OneJointTerm):
    """Model the half difference of forward and backward viscous friction."""

    symbols: ClassVar[tuple[Symbol, ...]] = (("delta_viscous", "N m s/rad", None),)
    kind: ClassVar[str] = "friction_asymmetric"

    def columns(self, robot: RobotModel, state: MotionState) -> list[Samples]:
        """Give |v|."""
        del robot
        return [np.abs(state.velocity[:, self.joint - 1])]
