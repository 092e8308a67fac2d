"""Give the torque of the links as rigid bodies: ten inertial parameters per link.

The series here come from the plain Newton-Euler recursion with one unit parameter at a time; `core/regressor`
computes the same series by a compiled kernel, and a test holds the two equal. Source: Khalil & Dombre (2002),
ch. 12.
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import Series
from ...robot.model import Parameter, RobotModel, inertial_parameters
from ...signals.state import MotionState
from ..newton_euler import inverse_dynamics
from ..term import Entry, Term


@dataclass(frozen=True)
class RigidBody(Term):
    """Model links as rigid bodies."""

    name: str = "rigid_body"
    loads = True

    def parameters(self, robot: RobotModel) -> tuple[Parameter, ...]:
        """List ten parameters per link in Khalil's order."""
        return tuple(
            parameter
            for number, link in enumerate(robot.links, start=1)
            for parameter in inertial_parameters(number, link.joint)
        )

    def entries(self, robot: RobotModel) -> tuple[Entry, ...]:
        """Pair every link's parameters with the joints that carry the link."""
        return tuple(
            (joint, 10 * link + position)
            for link, chain in enumerate(robot.supports)
            for joint in sorted({robot.links[carrier].joint - 1 for carrier in chain})
            for position in range(10)
        )

    def series(self, robot: RobotModel, state: MotionState) -> Series:
        """Give the torque per unit inertial parameter."""
        entries = self.entries(robot)
        rows = np.empty((len(entries), len(state.position)))
        for column in range(10 * len(robot.links)):
            unit = np.zeros(10 * len(robot.links))
            unit[column] = 1.0
            torque = inverse_dynamics(robot, unit.reshape(-1, 10), state.links)
            for row, (joint, parameter) in enumerate(entries):
                if parameter == column:
                    rows[row] = torque[:, joint]
        return rows
