"""Give load-dependent friction: sign(v) |load|, with the predicted load of the transmission.

Source: Bittencourt & Gunnarsson, J. Dyn. Sys. Meas. Control 134(5), 2012.
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import Series
from ...robot.model import RobotModel
from ...signals.state import MotionState
from ..gear import Gear
from ..prediction import Prediction
from .effect import OneJointTerm


@dataclass(frozen=True, eq=False)
class LoadFriction(OneJointTerm):
    """Model a Coulomb level that grows with the transmitted torque.

    The `motor_inertia`, kg m2 (kg), is the rotor inertia that the operating point's load contains.
    """

    believed: Prediction
    motor_inertia: float = 0.0
    symbols = (("load_coefficient", "1", 0.0),)
    kind = "friction_load_dependent"

    def series(self, robot: RobotModel, state: MotionState) -> Series:
        """Give sign(v) |load|, with the load on this robot."""
        load = Gear(self.believed, self.joint, self.motor_inertia).load(state, robot)
        return np.array([state.direction[:, self.joint - 1] * np.abs(load)])
