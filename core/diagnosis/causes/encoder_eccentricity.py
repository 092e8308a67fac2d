"""Candidate cause: an eccentric encoder disc, whose angle error repeats once per revolution."""

from dataclasses import dataclass, replace

import numpy as np

from ...dynamics.term import Term
from ...dynamics.terms.encoder_error import EncoderEccentricity as EncoderEccentricityTerm
from ...log.model import LogRows
from ...robot.model import RobotModel
from ..thresholds.causes import ADMISSIBLE, LINEARISATION
from .protocol import FittedCause, Numbers, Quantity, SearchTraits, Setting, Site, number_text
from .repairs import CorrectsLog
from .shared.harmonics import amplitude_and_angle
from .shared.own_joint import OwnJointCause


@dataclass(frozen=True)
class EncoderEccentricity(OwnJointCause, CorrectsLog):
    """Candidate cause: an encoder error that repeats with every revolution."""

    id = "encoder_eccentricity"
    title = "Encoder eccentricity"
    cure = "signal"
    units = (("amplitude", "rad"), ("phase", "rad"))
    experiment = "fast motion through as much of a revolution as the joint's range allows"
    coordinate = "position"
    traits = SearchTraits(
        linearisation_error=LINEARISATION.eccentricity, largest=ADMISSIBLE.encoder_eccentricity
    )
    revolute_only = True

    def term(self, at: Setting) -> Term:
        """Give the columns."""
        return EncoderEccentricityTerm(at.joint, at.operating_point)

    def admissible(self, solved: FittedCause) -> bool:
        """Admit an error that a first-order column can represent."""
        return bool(float(solved.values @ solved.values) < ADMISSIBLE.encoder_eccentricity**2)

    def represented(self, at: Setting, solved: FittedCause) -> bool:
        """Doubt an error whose second order, which the columns omit, is as large as their accuracy."""
        del at
        return bool(np.linalg.norm(solved.values) <= ADMISSIBLE.eccentricity_represented)

    def quantities(self, solved: FittedCause) -> tuple[Quantity, ...]:
        """Report amplitude and phase of the error amplitude sin(q + phase)."""
        (amplitude, wide), (phase, doubt) = amplitude_and_angle(solved.values, solved.covariance)
        joint = solved.site[0]
        return (
            Quantity("amplitude", joint, "rad", amplitude, wide),
            Quantity("phase", joint, "rad", phase, doubt),
        )

    def statement(self, solved: FittedCause) -> str:
        """State amplitude and phase of the error."""
        found = self.by_name(solved)
        return (
            f"Encoder eccentricity on joint {solved.site[0]}: angle error "
            f"{found['amplitude'].text} times sin(q + {found['phase'].value:.2g})"
        )

    def repair(self, robot: RobotModel, joints: Site, numbers: Numbers) -> str:
        """State what is subtracted from every reading."""
        del robot
        wave = f"{number_text(numbers['amplitude'], 4)} rad times sin(q + {number_text(numbers['phase'], 4)})"
        return f"From every angle q of joint {joints[0]} {wave} is subtracted"

    def corrected_rows(self, rows: LogRows, joints: Site, numbers: Numbers) -> LogRows:
        """Subtract the error from the angle, and from the speed where it is logged.

        The column has the error at the angle that was read, and so has its correction.
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
