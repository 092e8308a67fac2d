"""Candidate cause: a torque constant that varies with current, so that large torques read too high or low."""

from dataclasses import dataclass

import numpy as np

from ...arrays import JointSeries
from ...dynamics.term import Term
from ...dynamics.terms.torque_gain_nonlinear import CubicGain
from ...log.model import LogRows
from ...robot.model import RobotModel
from .protocol import FittedCause, Numbers, Setting, Site, number_text
from .repairs import CorrectsLog, with_torque
from .shared.own_joint import OwnJointCause


@dataclass(frozen=True)
class TorqueGainNonlinear(OwnJointCause, CorrectsLog):
    """Candidate cause: a torque constant that varies with current."""

    id = "torque_gain_nonlinear"
    title = "Nonlinear torque gain"
    cure = "signal"
    units = (("cubic_coefficient", "1/(N m)^2"),)
    experiment = "hold known payloads, up to the rated one, in the posture of the largest gravity torque"
    coordinate = "torque"

    def term(self, at: Setting) -> Term:
        """Give the column."""
        return CubicGain(at.joint, at.operating_point)

    def statement(self, solved: FittedCause) -> str:
        """State sign and size of the cubic part."""
        found = self.by_name(solved)
        high = "too high" if solved.values[0] > 0.0 else "too low"
        return (
            f"Nonlinear torque gain on joint {solved.site[0]}: large torques read {high}, torque plus "
            f"{found['cubic_coefficient'].text} times its cube"
        )

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """State the inverse of the gain curve."""
        del robot
        return (
            f"Every torque y of joint {joints[0]} becomes the x for which x plus "
            f"{number_text(numbers['cubic_coefficient'], 4)} 1/(N m)^2 times its cube is y"
        )

    def corrected_rows(self, rows: LogRows, joints: Site, numbers: Numbers) -> LogRows:
        """Invert the gain curve."""
        bend = numbers["cubic_coefficient"]
        return with_torque(rows, joints, lambda torque: inverse_cubic(torque, bend))


def inverse_cubic(torque: JointSeries, bend: float) -> JointSeries:
    """Give the x near zero for which x + bend x^3 is the torque, or comes nearest to it.

    Notes
    -----
    A cubic without a square has its root by a third of an angle (Vieta), hyperbolic where it only rises.

    Examples
    --------
    >>> inverse_cubic(np.array([[2.0 + 0.1 * 2.0**3]]), 0.1).round(12)
    array([[2.]])
    """
    size = float(np.sqrt(3.0 * abs(bend)))
    if size == 0.0:
        return torque
    if bend > 0.0:
        return np.asarray(2.0 / size * np.sinh(np.arcsinh(1.5 * size * torque) / 3.0))
    return np.asarray(2.0 / size * np.sin(np.arcsin(np.clip(1.5 * size * torque, -1.0, 1.0)) / 3.0))
