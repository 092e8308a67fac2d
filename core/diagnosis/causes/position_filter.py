"""Candidate cause: a zero-phase low-pass of the positions that the torques did not pass."""

from collections.abc import Sequence
from dataclasses import dataclass

from ...dynamics.term import Term
from ...dynamics.terms.position_filter import PositionFilter as PositionFilterTerm
from ...dynamics.terms.position_filter import cutoff_hz, time_power
from ...robot.model import RobotModel
from ..dataset.dataset import Dataset
from ..thresholds.causes import ADMISSIBLE, LINEARISATION
from .protocol import FittedCause, Numbers, Quantity, Scalars, SearchTraits, Setting, Site, number_text
from .shared.own_joint import OwnJointCause, geometric_grid

ORDERS = (1, 2)
"""A Gaussian or moving average has order 1; a Butterworth filter of order 2 that ran both ways, order 2."""
GAINS = (1.0, 12.0)
"""Largest gains of the inverse: positions that were rounded or noisy after the filter bear a small one."""
LOWEST, HIGHEST, STARTS = 1.5, 3.0, 8
"""Ends of the first cut-offs over the motion's band and the data set's, and how many there are."""


@dataclass(frozen=True)
class PositionFilter(OwnJointCause):
    """Candidate cause: a filter of the positions."""

    id = "position_filter"
    title = "Low-pass filter of the positions"
    cure = "signal"
    units = (("cutoff", "Hz"),)
    experiment = "the same motion, with the positions as the encoders give them"
    coordinate = "torque_rate"
    traits = SearchTraits(
        linearisation_error=LINEARISATION.position_filter,
        like_position_noise=True,
        self_consistent=("around",),
        discrete=("order", "most"),
    )

    def sites(self, dataset: Dataset) -> Sequence[Site]:
        """Act on the whole robot."""
        del dataset
        return [()]

    def grid(self, at: Setting) -> Sequence[Scalars]:
        """Begin at several cut-offs, from the motion's bandwidth to beyond the data set's."""
        ends = (LOWEST * at.dataset.motion_band_hz, HIGHEST * at.dataset.band_hz)
        return [
            {"order": float(order), "most": most, "around": time_power(cutoff, order)}
            for order in ORDERS
            for most in GAINS
            for cutoff in geometric_grid(*ends, STARTS)
        ]

    def term(self, at: Setting) -> Term:
        """Give the columns."""
        order = int(at.scalars["order"])
        slowest, fastest = (
            time_power(edge, order) for edge in (ADMISSIBLE.lowest_cutoff, ADMISSIBLE.highest_cutoff)
        )
        around = min(max(at.scalars["around"], fastest), slowest)
        return PositionFilterTerm(0, at.operating_point, around, order, int(at.scalars["most"]))

    def admissible(self, solved: FittedCause) -> bool:
        """Admit a filter that attenuates, and leaves some motion."""
        order = int(solved.scalars["order"])
        return bool(0.0 < solved.values[0] < time_power(ADMISSIBLE.lowest_cutoff, order))

    def quantities(self, solved: FittedCause) -> tuple[Quantity, ...]:
        """Report the frequency at which an amplitude is halved."""
        power, deviation = float(solved.values[0]), float(solved.covariance[0, 0] ** 0.5)
        order = int(solved.scalars["order"])
        cutoff = cutoff_hz(power, order)
        return (Quantity("cutoff", None, "Hz", cutoff, cutoff * deviation / (2.0 * order * power)),)

    def statement(self, solved: FittedCause) -> str:
        """State the cut-off."""
        found = self.by_name(solved)
        return (
            f"Low-pass filter of the positions of all joints, without delay: it halves amplitudes at "
            f"{found['cutoff'].text}, and the torques did not pass it"
        )

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """State what is done, and what would be better."""
        del robot, joints
        cutoff = number_text(numbers["cutoff"], 3)
        return (
            f"The model has the torque of what a low-pass at {cutoff} Hz takes from the motion as a further "
            "term. Positions logged without the filter, or torques that pass the same one, need none"
        )
