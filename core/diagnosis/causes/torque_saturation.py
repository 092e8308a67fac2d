"""Candidate cause: torque saturation, where the log keeps the command."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...dynamics.term import Term
from ...dynamics.terms.torque_saturation import Saturation
from ...robot.joint_units import joint_unit
from ...robot.model import RobotModel
from ..thresholds.causes import ADMISSIBLE
from .protocol import FittedCause, Numbers, Quantity, Scalars, SearchTraits, Setting, Site, number_text
from .shared.own_joint import OwnJointCause

SHARES = (0.55, 0.65, 0.74, 0.81, 0.86, 0.9, 0.93, 0.95, 0.967, 0.98, 0.99)
"""Limits, as shares of the motion's largest torque."""


@dataclass(frozen=True)
class TorqueSaturation(OwnJointCause):
    """Candidate cause: a clipped torque."""

    id = "torque_saturation"
    title = "Torque saturation, where the log keeps the command"
    cure = "signal"
    units = (("limit", "N m"),)
    experiment = "the same motion a tenth slower, which keeps the command below the limit"
    coordinate = "torque"
    traits = SearchTraits(at_peaks=True)

    def grid(self, at: Setting) -> Sequence[Scalars]:
        """Scan the limit below the largest torque of the motion."""
        largest = float(np.abs(at.operating_point.applied(at.dataset.state)[:, at.joint - 1]).max())
        return [{"limit": share * largest} for share in SHARES]

    def term(self, at: Setting) -> Term:
        """Give the columns."""
        return Saturation(at.joint, at.operating_point, at.scalars["limit"])

    def admissible(self, solved: FittedCause) -> bool:
        """Admit commands that are larger than the applied torque."""
        return super().admissible(solved) and bool(solved.values[0] > 0.0)

    def contradicted(self, at: Setting, solved: FittedCause) -> bool:
        """Refuse a limit that the motion exceeds, and one that the commanded torque never reaches.

        While a drive is limited it applies the limit.
        """
        commanded = np.abs(at.dataset.torque[:, at.joint - 1]).max()
        if commanded <= solved.scalars["limit"]:
            return True
        applied = np.abs(at.operating_point.applied(at.dataset.state)[:, at.joint - 1])
        reached = float(np.quantile(applied, ADMISSIBLE.saturation_quantile))
        return reached > (1.0 + ADMISSIBLE.saturation_excess) * solved.scalars["limit"]

    def quantities(self, solved: FittedCause) -> tuple[Quantity, ...]:
        """Give the limit, which is no more certain than the predicted torque that it clips."""
        limit = solved.scalars["limit"]
        deviation = float(np.hypot(solved.deviations.get("limit", 0.0), ADMISSIBLE.saturation_error * limit))
        return (Quantity("limit", solved.site[0], solved.unit("N m"), limit, deviation),)

    def statement(self, solved: FittedCause) -> str:
        """State the limit."""
        found = self.by_name(solved)
        return (
            f"Torque saturation on joint {solved.site[0]}: the applied torque is limited to "
            f"{found['limit'].text}, the log keeps the larger command"
        )

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """State why the log is not corrected: a limit one per cent off leaves a remainder like contacts."""
        limit = f"{number_text(numbers['limit'], 4)} {joint_unit(robot, joints[0], 'N m')}"
        return (
            f"The model has the excess as a further term; cutting the log's torque of joint {joints[0]} at "
            f"{limit} would be exact only with the exact limit"
        )
