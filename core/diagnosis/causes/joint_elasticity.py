"""Suspect a compliant gear between the motor's encoder and the link."""

from dataclasses import dataclass

from core.diagnosis.cause import Confusion, Quantity, Scalars, Site, Solved
from core.diagnosis.causes.common import OwnJointCause, named, shown
from core.diagnosis.look import Look
from core.dynamics.prediction import Prediction
from core.dynamics.term import Term
from core.dynamics.terms.elasticity import Elasticity


@dataclass(frozen=True)
class JointElasticity(OwnJointCause):
    """Suspect joint elasticity."""

    id = "joint_elasticity"
    title = "The gear is compliant"
    units = (("stiffness", "N m/rad"),)
    confusions = (
        Confusion(
            "time_delay",
            "both make the torque seem late; a delay is the same on all joints and loads",
            "repeat the motion with a payload: a compliant gear's lag grows with the inertia",
        ),
        Confusion(
            "backlash",
            "both shift the link against the motor; backlash only where the load changes its sign",
            "repeat in a posture where gravity never lets the load change its sign",
        ),
    )
    experiment = "motion with large accelerations, up to a third of the expected resonance"
    coordinate = "load_jerk"

    def term(self, look: Look, believed: Prediction, site: Site, scalars: Scalars) -> Term:
        """Give the columns."""
        del scalars
        return Elasticity(site[0], believed, 12.0 * look.motion_band_hz)

    def possible(self, solved: Solved) -> bool:
        """Want a spring that gives way."""
        return super().possible(solved) and bool(solved.values[0] > 0.0)

    def quantities(self, solved: Solved) -> tuple[Quantity, ...]:
        """Report the stiffness; its relative deviation is the compliance's."""
        compliance, deviation = float(solved.values[0]), float(solved.covariance[0, 0] ** 0.5)
        return (
            Quantity("stiffness", solved.site[0], "N m/rad", 1.0 / compliance, deviation / compliance**2),
        )

    def statement(self, solved: Solved) -> str:
        """Say how stiff the gear is."""
        found = named(self.quantities(solved))
        return (
            f"Joint {solved.site[0]}'s gear gives way under load: stiffness {shown(found['stiffness'])} "
            "between the motor's encoder and the link"
        )
