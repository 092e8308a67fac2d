"""Suspect that a spring or counterbalance acts on a joint beside its motor."""

from dataclasses import dataclass

from ...dynamics.prediction import Prediction
from ...dynamics.term import Term
from ...dynamics.terms.spring import Spring
from ..dataset.dataset import Dataset
from .protocol import FittedCause, Scalars, Site
from .shared.common import OwnJointCause, named, shown


@dataclass(frozen=True)
class SpringCompensator(OwnJointCause):
    """Suspect a spring beside the motor."""

    id = "spring_compensator"
    title = "A spring acts beside the motor"
    units = (("stiffness", "N m/rad"),)
    experiment = "hold ten postures spread over the whole range of the joint"
    coordinate = "position"

    def term(self, dataset: Dataset, operating_point: Prediction, site: Site, scalars: Scalars) -> Term:
        """Give the column."""
        del dataset, operating_point, scalars
        return Spring(site[0])

    def statement(self, solved: FittedCause) -> str:
        """Say how stiff the spring is, and whether it pulls back or helps on."""
        found = named(self.quantities(solved))
        does = "pulls back to" if solved.values[0] > 0.0 else "pushes away from"
        return (
            f"A spring of {shown(found['stiffness'])} acts on joint {solved.site[0]} beside the motor; it "
            f"{does} its rest angle, which the torque offset hides"
        )
