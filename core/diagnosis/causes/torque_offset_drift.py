"""Candidate cause: a drift of a torque channel's offset during the log."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...dynamics.term import Term
from ...dynamics.terms.torque_offset_drift import Drift, course
from ...log.model import LogRows
from ...robot.joint_units import joint_unit
from ...robot.model import RobotModel
from ..dataset.dataset import Dataset
from ..thresholds.causes import ADMISSIBLE
from .protocol import FittedCause, Numbers, Scalars, Setting, Site, number_text
from .repairs import CorrectsLog, with_torque
from .shared.own_joint import OwnJointCause

SHARES = (0.05, 0.1, 0.2, 0.4, 0.8, 20.0)
"""Time constants of the drift, as shares of the data set's duration; the last is a linear drift."""


@dataclass(frozen=True)
class TorqueOffsetDrift(OwnJointCause, CorrectsLog):
    """Candidate cause: a drifting torque offset."""

    id = "torque_offset_drift"
    title = "Torque offset drift"
    cure = "signal"
    units = (("total_drift", "N m"), ("time_constant", "s"))
    experiment = "hold the same posture at the start and at the end of a log as long as the task"
    coordinate = "time"

    def grid(self, at: Setting) -> Sequence[Scalars]:
        """Scan the time constant."""
        return [{"time_constant": share * float(np.ptp(at.dataset.time))} for share in SHARES]

    def term(self, at: Setting) -> Term:
        """Give the column."""
        time = at.dataset.time
        return Drift(at.joint, float(time.min()), float(np.ptp(time)), at.scalars["time_constant"])

    def represented(self, at: Setting, solved: FittedCause) -> bool:
        """Doubt a drift that is over within seconds: it is what friction and hoses remember of before."""
        del at
        return solved.scalars["time_constant"] >= ADMISSIBLE.least_warm_up

    def statement(self, solved: FittedCause) -> str:
        """State total drift and time constant."""
        found = self.by_name(solved)
        return (
            f"Torque offset drift on joint {solved.site[0]}: {found['total_drift'].text} over the "
            f"log, time constant {found['time_constant'].value:.2g} s"
        )

    def numbers(self, dataset: Dataset, solved: FittedCause) -> Numbers:
        """Give the reported numbers, and when the drift begins and how long it lasts."""
        span = {"start": float(dataset.time.min()), "duration": float(np.ptp(dataset.time))}
        return {**super().numbers(dataset, solved), **span}

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """State the drift that is subtracted."""
        size = f"{number_text(numbers['total_drift'], 4)} {joint_unit(robot, joints[0], 'N m')}"
        end = numbers["start"] + numbers["duration"]
        return (
            f"A drift is subtracted from the torque of joint {joints[0]}: from 0 at "
            f"{number_text(numbers['start'], 4)} s to {size} at {number_text(end, 4)} s, with a time "
            f"constant of {number_text(numbers['time_constant'], 4)} s"
        )

    def corrected_rows(self, rows: LogRows, joints: Site, numbers: Numbers) -> LogRows:
        """Subtract the drift."""
        passed = rows.time - numbers["start"]
        share = course(passed, numbers["duration"], numbers["time_constant"])
        return with_torque(rows, joints, lambda torque: torque - numbers["total_drift"] * share[:, None])
