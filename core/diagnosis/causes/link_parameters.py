"""Suspect that the reference has a link's inertial parameters wrong, in a way that no added body explains."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...dynamics.prediction import Prediction
from ...dynamics.term import Term
from ...dynamics.terms.link_change import LinkChange
from ...robot.model import RobotModel
from ...robot.parameters import INERTIAL_SYMBOLS, INERTIAL_UNITS
from ..dataset.dataset import Dataset
from .protocol import FittedCause, Numbers, Quantity, Scalars, Site
from .shared.bodies import is_body
from .shared.common import OwnJointCause, shown
from .shared.sites import links_by_joint

TOLD = 3
"""Numbers that a sentence bears."""


@dataclass(frozen=True)
class LinkParameters(OwnJointCause):
    """Suspect all ten parameters of a link."""

    id = "link_parameters"
    title = "A link's inertial parameters are not the reference's"
    cure = "robot"
    units = tuple((f"delta_{symbol}", INERTIAL_UNITS[symbol]) for symbol in INERTIAL_SYMBOLS)
    experiment = "quick motion of all joints at once through postures in which this link hangs and lies"
    coordinate = "position"

    def sites(self, dataset: Dataset, operating_point: Prediction) -> Sequence[Site]:
        """List the joints with a link of their own."""
        del operating_point
        return [(joint,) for joint in links_by_joint(dataset.robot)]

    def term(self, dataset: Dataset, operating_point: Prediction, site: Site, scalars: Scalars) -> Term:
        """Give the columns."""
        del operating_point, scalars
        return LinkChange(site[0], links_by_joint(dataset.robot)[site[0]])

    def admissible(self, solved: FittedCause) -> bool:
        """Want a difference that is neither a body nor minus one: such a one is a payload."""
        return super().admissible(solved) and not is_body(solved.values, solved.covariance)

    def statement(self, solved: FittedCause) -> str:
        """Say which of the ten are furthest from the reference, in units of how well they are known."""
        clear = sorted(self.quantities(solved), key=_clearness, reverse=True)[:TOLD]
        told = [one for one in clear if _clearness(one) > 2.0] or clear[:1]
        changes = ", ".join(f"{one.name.removeprefix('delta_')} by {shown(one)}" for one in told)
        return f"The link of joint {solved.site[0]} is not the reference's: {changes}"

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """Say that a description holds no inertial parameters but those believed beforehand."""
        del robot, numbers
        return (
            f"The description stays as it is: identified anew, the link of joint {joints[0]} has its own "
            "parameters"
        )


def _clearness(one: Quantity) -> float:
    return float(np.abs(one.value) / max(one.standard_deviation, 1e-300))
