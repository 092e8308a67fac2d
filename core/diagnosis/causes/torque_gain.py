"""Candidate cause: a gain error of a torque channel: torque constant, gear ratio or sensor."""

from collections.abc import Sequence
from dataclasses import dataclass

from ...dynamics.term import Term
from ...dynamics.terms.torque_gain import CommonGain
from ...dynamics.terms.torque_gain import TorqueGain as TorqueGainTerm
from ...log.model import LogRows
from ...robot.model import RobotModel
from ..dataset.dataset import Dataset
from ..thresholds.causes import ADMISSIBLE
from .protocol import FittedCause, Numbers, SearchTraits, Setting, Site, number_text
from .repairs import CorrectsLog, with_torque
from .shared.own_joint import OwnJointCause


@dataclass(frozen=True)
class TorqueGain(OwnJointCause, CorrectsLog):
    """Candidate cause: a wrong torque constant."""

    together: bool = False
    """Whether all channels have the same gain error, which shows only against a reference: without one it
    equals bodies and friction that are larger by that share."""

    id = "torque_gain"
    title = "Torque gain error"
    cure = "signal"
    units = (("relative_error", "1"),)
    experiment = "motion of all joints that carry the same bodies, then the same with a weighed payload"
    coordinate = "torque"
    traits = SearchTraits(largest=ADMISSIBLE.torque_gain)

    def sites(self, dataset: Dataset) -> Sequence[Site]:
        """List every joint, or the robot as a whole."""
        return [()] if self.together else super().sites(dataset)

    def term(self, at: Setting) -> Term:
        """Give the column."""
        return TorqueGainTerm(at.joint, at.operating_point) if at.site else CommonGain(0, at.operating_point)

    def admissible(self, solved: FittedCause) -> bool:
        """Admit a gain error of less than nine tenths."""
        return bool(abs(solved.values[0]) < ADMISSIBLE.torque_gain)

    def statement(self, solved: FittedCause) -> str:
        """State the gain error in per cent."""
        found = self.by_name(solved)["relative_error"]
        way = "high" if found.value > 0.0 else "low"
        size = f"{100.0 * abs(found.value):.3g} ± {number_text(100.0 * found.standard_deviation)} % too {way}"
        if not solved.site:
            return f"Torque gain error of all channels: they read {size} against the reference"
        return (
            f"Torque gain error on joint {solved.site[0]}: the channel reads {size} against the other joints"
        )

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """State the divisor of the channel."""
        del robot
        which = f"joint {joints[0]}" if len(joints) == 1 else "every joint"
        return f"The torque of {which} is divided by {number_text(1.0 + numbers['relative_error'], 4)}"

    def corrected_rows(self, rows: LogRows, joints: Site, numbers: Numbers) -> LogRows:
        """Divide the channel by its gain."""
        return with_torque(rows, joints, lambda torque: torque / (1.0 + numbers["relative_error"]))
