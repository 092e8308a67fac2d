"""Give the torque of motors that are coupled to a sum of joints: inertia, viscous and Coulomb friction.

By virtual work the motor's torque acts on joint i with the weight that joint i has in the sum. Source:
Staubli wrists 5-6, as in Janot, Vandanjon & Gautier, IEEE TCST 22(1), 2014.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from ...arrays import Samples, Series
from ...robot.model import Coupling, Parameter, RobotModel
from ...signals.state import MotionState
from ..term import Entry, Term
from .coulomb import direction


@dataclass(frozen=True)
class GearCoupling(Term):
    """Model coupled motors: IAM, FVM and FCM of every declared coupling; widths in rad/s as for `Coulomb`."""

    widths: tuple[float, ...] = ()
    name: str = "coupling"

    def parameters(self, robot: RobotModel) -> tuple[Parameter, ...]:
        """List IAM, FVM, FCM of every coupling."""
        units = (("IAM", "kg m2"), ("FVM", "N m s/rad"), ("FCM", "N m"))
        return tuple(
            Parameter(symbol, coupling.number, coupling.number, unit, 0.0)
            for coupling in robot.couplings
            for symbol, unit in units
        )

    def entries(self, robot: RobotModel) -> tuple[Entry, ...]:
        """Pair the three parameters of a coupling with each of its joints."""
        return tuple(
            (joint - 1, 3 * index + position)
            for index, coupling in enumerate(robot.couplings)
            for joint in coupling.joints
            for position in range(3)
        )

    def series(self, robot: RobotModel, state: MotionState) -> Series:
        """Give the torque per unit parameter."""
        rows: list[Samples] = []
        widths = self.widths or (0.0,) * len(robot.couplings)
        for index, (coupling, width) in enumerate(zip(robot.couplings, widths, strict=True)):
            motor = motor_speed(coupling, state)
            if state.friction_share is None:
                dry = state.by_stamps(partial(_motor_direction, coupling, width))
            else:
                dry = state.friction_share[:, len(robot.joints) + index]
            columns = (_weighted_sum(coupling, state.acceleration), motor, dry)
            rows += [weight * column for weight in coupling.weights for column in columns]
        return np.array(rows).reshape(len(rows), len(state.position))


def coupling_widths(robot: RobotModel, widths: Sequence[float]) -> tuple[float, ...]:
    """Give every declared coupling the largest width of its joints."""
    return tuple(max(widths[joint - 1] for joint in coupling.joints) for coupling in robot.couplings)


def motor_speed(coupling: Coupling, state: MotionState) -> Samples:
    """Give the speed of a coupled motor, rad/s."""
    return _weighted_sum(coupling, state.velocity)


def _motor_direction(coupling: Coupling, width: float, velocity: np.ndarray) -> Samples:
    return direction(_weighted_sum(coupling, velocity), width)


def _weighted_sum(coupling: Coupling, values: np.ndarray) -> Samples:
    joints = [joint - 1 for joint in coupling.joints]
    return np.asarray(values[:, joints] @ np.array(coupling.weights))
