"""Give what a compliant gear adds when the encoder sits on the motor: the link lags by torque over stiffness.

To first order in the compliance 1 / K the link's position is q - x, with M x'' + (D + S) x' + K x = load: its
own inertia M swings on spring and damper. M and S, by which the load grows with the link's own speed, change
with the motion. What the load changes by is linear in 1 / K where M / K and D / K are known.
Sources: Spong, J. Dyn. Sys. Meas. Control 109, 1987; Newmark, J. Eng. Mech. Div. 85, 1959.
"""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from core.arrays import JointSeries, Samples
from core.dynamics.gear import Gear
from core.dynamics.prediction import Prediction
from core.dynamics.terms.effect import AllJointsTerm, Symbol, step_of
from core.recursions import spring
from core.robot.joint_units import joint_unit
from core.robot.model import RobotModel
from core.robot.parameters import Parameter
from core.signals.state import MotionState

LEAST = 0.02
"""Share of its inertia below which no link's falls: what is believed of one may be too little to be real."""
WILD = 100.0
"""Times its load: what swings so far is driven by an inertia that is believed wrongly, and is nothing."""
TURN, PARTS = 0.1, 8
"""Angle in rad by which the spring swings in a step of its integration at most; but no more parts of a sample
than so many: what swings quicker than that lies far above any log's band."""


@dataclass(frozen=True, eq=False)
class Elasticity(AllJointsTerm):
    """Model a compliant gear.

    Attributes
    ----------
    resonance_hz, damping_ratio
        Of an inertia on the gear's spring: below it the link follows the load at once.
    inertia
        Which inertia that is, above zero, kg m2 (kg): the link's own changes, and its resonance with it.
    motor_inertia
        What the believed load holds of the rotor's inertia, kg m2 (kg).
    """

    believed: Prediction
    resonance_hz: float
    damping_ratio: float
    inertia: float
    motor_inertia: float = 0.0
    symbols: ClassVar[tuple[Symbol, ...]] = (("compliance", "rad/(N m)", 0.0),)
    kind: ClassVar[str] = "joint_elasticity"
    remembers: ClassVar[bool] = True

    def parameters(self, robot: RobotModel) -> tuple[Parameter, ...]:
        """List the compliance, in the unit of its joint."""
        return tuple(
            replace(one, unit=joint_unit(robot, self.joint, one.unit)) for one in super().parameters(robot)
        )

    def torques(self, robot: RobotModel, state: MotionState) -> list[JointSeries]:
        """Give the change of all joints' loads per unit of compliance."""
        del robot
        gear, own = Gear(self.believed, self.joint, self.motor_inertia), self.joint - 1
        angular = 2.0 * np.pi * self.resonance_hz
        stiffness = self.inertia * angular**2
        inertia, least = gear.inertia(state), LEAST * self.inertia
        drag = np.where(inertia > least, self.believed.slopes(state, own)[1][:, own], 0.0) / stiffness
        damping = 2.0 * self.damping_ratio / angular + drag
        load = gear.load(state)
        gives = sprung(load, np.maximum(inertia, least) / stiffness, damping, step_of(state))
        if not np.abs(gives[:, 0]).max() < WILD * np.abs(load).max():
            gives = np.zeros_like(gives)
        return [gear.change(state, MotionState(*(-gives.T[:, :, None])))]


def sprung(load: Samples, inertia: Samples, damping: Samples, step: float) -> JointSeries:
    """Let a spring of stiffness one give way under a load, with an inertia on it; at first it rests.

    Parameters
    ----------
    load
        One value per sample.
    inertia, damping
        Over the stiffness, s^2 and s.
    step
        Time between samples, s.

    Returns
    -------
    JointSeries
        By how much it gives way, how quickly, and the rate of that: one column each.

    Examples
    --------
    Under a load that stays, it stays where it is.

    >>> gives = sprung(np.full(3, 2.0), np.full(3, 0.01), np.full(3, 0.1), 0.1)
    >>> bool(np.allclose(gives, [2.0, 0.0, 0.0]))
    True
    """
    found = np.empty((len(load), 3))
    parts = np.clip(np.ceil(step / (TURN * np.sqrt(inertia.min()))), 1, PARTS)
    spring(np.ascontiguousarray(load), inertia, damping, step, int(parts), found)
    return found
