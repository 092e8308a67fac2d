"""Candidate cause: a torque channel that lags or leads the positions by the same time on all joints."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from ...dynamics.term import Term
from ...dynamics.terms.time_delay import Delay
from ...log.model import LogRows
from ...robot.model import RobotModel
from ..dataset.dataset import Dataset
from ..thresholds.causes import ADMISSIBLE
from .protocol import FittedCause, Numbers, Scalars, SearchTraits, Setting, Site, number_text
from .repairs import CorrectsLog, with_torque
from .shared.own_joint import OwnJointCause

STARTS = (-0.02, -0.005, 0.0, 0.005, 0.02)


@dataclass(frozen=True)
class TimeDelay(OwnJointCause, CorrectsLog):
    """Candidate cause: a delay of the torque channel."""

    id = "time_delay"
    title = "Torque channel delay"
    cure = "signal"
    units = (("delay", "s"),)
    experiment = "motion with fast reversals, at five times the present frequencies"
    coordinate = "torque_rate"
    traits = SearchTraits(
        like_position_noise=True, self_consistent=("around",), largest=ADMISSIBLE.time_delay
    )

    def sites(self, dataset: Dataset) -> Sequence[Site]:
        """Act on the whole robot."""
        del dataset
        return [()]

    def grid(self, at: Setting) -> Sequence[Scalars]:
        """Begin at several delays."""
        del at
        return [{"around": start} for start in STARTS]

    def term(self, at: Setting) -> Term:
        """Give the columns."""
        around = np.clip(at.scalars["around"], -ADMISSIBLE.time_delay, ADMISSIBLE.time_delay)
        return Delay(0, at.operating_point, float(around))

    def admissible(self, solved: FittedCause) -> bool:
        """Admit a delay that a first-order column can represent."""
        return bool(abs(solved.values[0]) < ADMISSIBLE.time_delay)

    def represented(self, at: Setting, solved: FittedCause) -> bool:
        """Doubt a torque that is ahead by less than a sample, as one held from sample to sample is."""
        held = max(1.0 / motion.log.rate_hz for motion in at.dataset.motions)
        return not -held < float(solved.values[0]) < 0.0

    def statement(self, solved: FittedCause) -> str:
        """State the delay in milliseconds."""
        found = self.by_name(solved)["delay"]
        late = "behind" if found.value > 0.0 else "ahead of"
        size, doubt = number_text(1e3 * abs(found.value), 3), number_text(1e3 * found.standard_deviation)
        return f"Torque channel delay on all joints: {size} ± {doubt} ms {late} the positions"

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """State the shift in milliseconds."""
        del robot, joints
        way = "earlier" if numbers["delay"] > 0.0 else "later"
        return (
            f"All torques are shifted {number_text(1e3 * abs(numbers['delay']), 4)} ms {way} in the log, by "
            "interpolation"
        )

    def corrected_rows(self, rows: LogRows, joints: Site, numbers: Numbers) -> LogRows:
        """Shift the torque; beyond the ends it is constant."""
        then = np.clip(rows.time + numbers["delay"], rows.time[0], rows.time[-1])
        return with_torque(rows, joints, lambda torque: np.asarray(CubicSpline(rows.time, torque)(then)))

    def reach(self, numbers: Numbers) -> float:
        """Give the delay: torque over this time at one end is not in the log."""
        return abs(numbers["delay"])
