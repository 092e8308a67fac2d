"""Give the friction that grows with the torque a gear transmits: sign(v) |load|, the load as predicted.

What turns with the motor needs no gear. A model whose base parameters hold a rotor's inertia in the link's
predicts too much load, by that inertia times the acceleration.

Source: Bittencourt & Gunnarsson, J. Dyn. Sys. Meas. Control 134(5), 2012.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from core.arrays import Samples
from core.dynamics.prediction import Prediction
from core.dynamics.terms.effect import OneJointTerm, Symbol
from core.robot.model import RobotModel
from core.signals.state import MotionState


@dataclass(frozen=True, eq=False)
class LoadFriction(OneJointTerm):
    """Model a Coulomb level that grows with the transmitted torque.

    The `motor_inertia`, kg m2 (kg), is what the believed load holds of the rotor's.
    """

    believed: Prediction
    motor_inertia: float = 0.0
    symbols: ClassVar[tuple[Symbol, ...]] = (("load_coefficient", "1", 0.0),)
    kind: ClassVar[str] = "friction_load_dependent"

    def columns(self, robot: RobotModel, state: MotionState) -> list[Samples]:
        """Give sign(v) |load|."""
        own = self.joint - 1
        load = self.believed.load(state, robot)[:, own] - self.motor_inertia * state.acceleration[:, own]
        return [np.sign(state.velocity[:, own]) * np.abs(load)]
