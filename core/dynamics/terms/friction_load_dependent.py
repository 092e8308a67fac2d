"""Give load-dependent friction: sign(v) |load|, with the predicted load of the transmission.

Source: Bittencourt & Gunnarsson, J. Dyn. Sys. Meas. Control 134(5), 2012.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...arrays import Samples
from ...robot.model import RobotModel
from ...signals.state import MotionState
from ..gear import Gear
from ..prediction import Prediction
from .effect import OneJointTerm, Symbol


@dataclass(frozen=True, eq=False)
class LoadFriction(OneJointTerm):
    """Model a Coulomb level that grows with the transmitted torque.

    The `motor_inertia`, kg m2 (kg), is the rotor inertia that the operating point's load contains.
    """

    believed: Prediction
    motor_inertia: float = 0.0
    symbols: ClassVar[tuple[Symbol, ...]] = (("load_coefficient", "1", 0.0),)
    kind: ClassVar[str] = "friction_load_dependent"

    def columns(self, robot: RobotModel, state: MotionState) -> list[Samples]:
        """Give sign(v) |load|."""
        load = Gear(self.believed, self.joint, self.motor_inertia).load(state, robot)
        return [np.sign(state.velocity[:, self.joint - 1]) * np.abs(load)]
