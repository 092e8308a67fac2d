"""Candidate cause: a low-pass filter in the torque channel that the positions did not pass."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from ...arrays import InstantSeries, JointSeries, Samples
from ...dynamics.term import Term
from ...dynamics.terms.torque_filter_lag import FilterLag
from ...log.model import LogRows
from ...numerics.filtering import convolved
from ...robot.model import RobotModel
from ...signals.zero_phase import kernel
from ..dataset.dataset import Dataset
from ..thresholds.causes import ADMISSIBLE
from .protocol import FittedCause, Numbers, Scalars, SearchTraits, Setting, Site, number_text
from .repairs import CorrectsLog, with_torque
from .shared.own_joint import OwnJointCause

STARTS = (0.001, 0.004, 0.016, 0.064)
ORDER = 2
PERIODS = 3.0
"""Periods of the band's edge beyond which less than a millionth of the filter's mass lies."""


@dataclass(frozen=True)
class TorqueFilterLag(OwnJointCause, CorrectsLog):
    """Candidate cause: a filter in the torque channel."""

    id = "torque_filter_lag"
    title = "Low-pass filter in the torque channel"
    cure = "signal"
    units = (("time_constant", "s"),)
    experiment = "motion with fast reversals, at five times the present frequencies"
    coordinate = "torque_rate"
    traits = SearchTraits(
        like_position_noise=True, self_consistent=("around",), largest=ADMISSIBLE.filter_lag
    )

    def sites(self, dataset: Dataset) -> Sequence[Site]:
        """Act on the whole robot."""
        del dataset
        return [()]

    def grid(self, at: Setting) -> Sequence[Scalars]:
        """Begin at several time constants."""
        del at
        return [{"around": start} for start in STARTS]

    def term(self, at: Setting) -> Term:
        """Give the columns."""
        around = np.clip(at.scalars["around"], ADMISSIBLE.least_filter_lag, ADMISSIBLE.filter_lag)
        return FilterLag(0, at.operating_point, float(around))

    def admissible(self, solved: FittedCause) -> bool:
        """Admit a filter that lags."""
        return bool(0.0 < solved.values[0] < ADMISSIBLE.filter_lag)

    def statement(self, solved: FittedCause) -> str:
        """State the time constant."""
        found = self.by_name(solved)["time_constant"]
        return (
            f"Low-pass filter in the torque channel of all joints: time constant {1e3 * found.value:.3g} ± "
            f"{number_text(1e3 * found.standard_deviation)} ms, without a filter of the positions"
        )

    def numbers(self, dataset: Dataset, solved: FittedCause) -> Numbers:
        """Give the reported number, and the bandwidth in which it was found."""
        return {**super().numbers(dataset, solved), "band_hz": dataset.band_hz}

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """State what is added."""
        del robot, joints
        size, band = number_text(1e3 * numbers["time_constant"], 4), number_text(numbers["band_hz"], 3)
        return f"Every torque is increased by {size} ms times its rate of change, taken up to {band} Hz"

    def corrected_rows(self, rows: LogRows, joints: Site, numbers: Numbers) -> LogRows:
        """Invert the filter: its input is tau + T tau'; above the bandwidth a rate is mostly noise."""
        samples = round(float(np.ptp(rows.time)) / float(np.median(np.diff(rows.time)))) + 1
        even, step = np.linspace(rows.time[0], rows.time[-1], samples, retstep=True)
        low_pass = kernel(numbers["band_hz"], 1.0 / float(step), ORDER)

        def undone(torque: JointSeries) -> JointSeries:
            smooth = CubicSpline(even, _passed(CubicSpline(rows.time, torque)(even), low_pass))
            return np.asarray(torque + numbers["time_constant"] * smooth(rows.time, 1))

        return with_torque(rows, joints, undone)

    def reach(self, numbers: Numbers) -> float:
        """Give the time that the bandwidth's filter spans."""
        return PERIODS / numbers["band_hz"]


def _passed(series: InstantSeries, low_pass: Samples) -> InstantSeries:
    half = len(low_pass) // 2
    padded = np.pad(series, ((half, half), (0, 0)), mode="edge")
    return convolved(padded, low_pass)
