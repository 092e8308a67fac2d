"""Suspect that a joint's encoder disc sits off its axis: an angle error once per turn."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...dynamics.prediction import Prediction
from ...dynamics.term import Term
from ...dynamics.terms.encoder import EncoderEccentricity as EncoderEccentricityTerm
from ...log.model import LogRows
from ...robot.model import RobotModel
from ..dataset.dataset import Dataset
from .protocol import FittedCause, Numbers, Quantity, Scalars, Site
from .repairs import CorrectsLog
from .shared.common import OwnJointCause, named, rounded, shown
from .shared.sites import revolute_joints
from .shared.waves import amplitude_and_angle
from .traits import SearchTraits

LARGEST = 0.3


@dataclass(frozen=True)
class EncoderEccentricity(OwnJointCause, CorrectsLog):
    """Suspect an encoder error that repeats with every turn."""

    id = "encoder_eccentricity"
    title = "The encoder errs once per turn"
    cure = "signal"
    units = (("amplitude", "rad"), ("phase", "rad"))
    experiment = "quick motion through as much of a turn as the joint's range allows"
    coordinate = "position"
    traits = SearchTraits(linearisation_error=0.1)

    def sites(self, dataset: Dataset, operating_point: Prediction) -> Sequence[Site]:
        """List the joints that turn."""
        del operating_point
        return [(joint,) for joint in revolute_joints(dataset.robot)]

    def term(self, dataset: Dataset, operating_point: Prediction, site: Site, scalars: Scalars) -> Term:
        """Give the columns."""
        del dataset, scalars
        return EncoderEccentricityTerm(site[0], operating_point)

    def admissible(self, solved: FittedCause) -> bool:
        """Want an error that a first-order column can stand for."""
        return bool(float(solved.values @ solved.values) < LARGEST**2)

    def quantities(self, solved: FittedCause) -> tuple[Quantity, ...]:
        """Report amplitude and phase of the error amplitude sin(q + phase)."""
        (amplitude, wide), (phase, with_other_holdout) = amplitude_and_angle(solved.values, solved.covariance)
        joint = solved.site[0]
        return (
            Quantity("amplitude", joint, "rad", amplitude, wide),
            Quantity("phase", joint, "rad", phase, with_other_holdout),
        )

    def statement(self, solved: FittedCause) -> str:
        """Say how large the error is and where."""
        found = named(self.quantities(solved))
        return (
            f"Joint {solved.site[0]}'s encoder errs once per turn, by {shown(found['amplitude'])} times "
            f"sin(q + {found['phase'].value:.2g})"
        )

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """Say what every reading is less by."""
        del robot
        wave = f"{rounded(numbers['amplitude'], 4)} rad times sin(q + {rounded(numbers['phase'], 4)})"
        return f"From every angle q of joint {joints[0]} {wave} is subtracted"

    def corrected_rows(self, rows: LogRows, joints: Site, numbers: Numbers) -> LogRows:
        """Take the error out of the angle, and out of the speed where it is logged.

        The column has the error at the angle that was read, and so has its repair.
        """
        own, amplitude = joints[0] - 1, numbers["amplitude"]
        turn = rows.position[:, own] + numbers["phase"]
        position = rows.position.copy()
        position[:, own] -= amplitude * np.sin(turn)
        if rows.velocity is None:
            return replace(rows, position=position)
        velocity = rows.velocity.copy()
        velocity[:, own] *= 1.0 - amplitude * np.cos(turn)
        return replace(rows, position=position, velocity=velocity)
