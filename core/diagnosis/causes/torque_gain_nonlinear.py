"""Suspect that the torque constant varies with current, so that large torques read too high or too low."""

from dataclasses import dataclass

from core.diagnosis.cause import Confusion, Scalars, Site, Solved
from core.diagnosis.causes.common import OwnJointCause, named, shown
from core.diagnosis.look import Look
from core.dynamics.prediction import Prediction
from core.dynamics.term import Term
from core.dynamics.terms.cubic_gain import CubicGain


@dataclass(frozen=True)
class TorqueGainNonlinear(OwnJointCause):
    """Suspect a torque constant that varies with current."""

    id = "torque_gain_nonlinear"
    title = "The torque constant varies with current"
    cure = "signal"
    units = (("cubic_coefficient", "1/(N m)^2"),)
    confusions = (
        Confusion(
            "torque_saturation",
            "both act at large torques; a clipped torque ends at one level, a bent gain goes on",
            "raise a payload step by step: a bent gain shows below the largest torque, too",
        ),
        Confusion(
            "friction_load_dependent",
            "both grow with the torque; only friction changes its sign with the direction of motion",
            "pass the same loaded posture slowly in both directions",
        ),
    )
    experiment = "hold known payloads, up to the rated one, in the posture of the largest gravity torque"
    coordinate = "torque"

    def term(self, look: Look, believed: Prediction, site: Site, scalars: Scalars) -> Term:
        """Give the column."""
        del look, scalars
        return CubicGain(site[0], believed)

    def statement(self, solved: Solved) -> str:
        """Say which way the channel bends."""
        found = named(self.quantities(solved))
        high = "too high" if solved.values[0] > 0.0 else "too low"
        return (
            f"Joint {solved.site[0]}'s torque channel reads large torques {high}: torque plus "
            f"{shown(found['cubic_coefficient'])} times its cube"
        )
