"""Give joints a spring and a damper between motor and link.

The sum of both sides' equations holds no torque of the spring: motor and load together are what the drive
moves. It shows in the motion of the links, M(q_l) ddq_l + c + g = k (q_m - q_l) + d (dq_m - dq_l), with the
measured motor q_m. Source: Spong, J. Dyn. Sys. Meas. Control 109, 1987.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...arrays import Series
from ...robot.joint_units import joint_unit
from ...robot.model import Parameter, RobotModel
from ...signals.state import MotionState
from ..term import Entry, Term

STIFFNESS, DAMPING = "KS", "DS"
"""Symbols of a joint's spring and damper."""


@dataclass(frozen=True)
class FlexibleJoints(Term):
    """Model stiffness KS and damping DS between the motors and the links of some joints."""

    flexible: tuple[int, ...]
    """Numbers of the joints, from 1, rising."""
    name: str = "flexible_joints"
    shapes_motion: ClassVar[bool] = True

    def parameters(self, robot: RobotModel) -> tuple[Parameter, ...]:
        """List stiffness and damping of every such joint, in its units."""
        symbols = ((STIFFNESS, "N m/rad"), (DAMPING, "N m s/rad"))
        return tuple(
            Parameter(symbol, joint, joint, joint_unit(robot, joint, unit), 0.0)
            for joint in self.flexible
            for symbol, unit in symbols
        )

    def entries(self, robot: RobotModel) -> tuple[Entry, ...]:
        """List none: no torque of motor and load together is the spring's."""
        del robot
        return ()

    def series(self, robot: RobotModel, state: MotionState) -> Series:
        """Give no row."""
        del robot
        return np.zeros((0, len(state.position)))
