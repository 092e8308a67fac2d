"""Compare a spring's stiffness with the one that its resonance and the link's inertia give.

A link on a spring resonates at the square root of stiffness over inertia. Whatever else swings with the arm
(its base, a liquid, a load that hangs) has another mass than the link: what it adds to the torque gives a
stiffness that does not belong to its rate. Source: Spong, J. Dyn. Sys. Meas. Control 109, 1987.
"""

import numpy as np

from ...dynamics.gear import Gear
from ..causes.joint_elasticity import JointElasticity
from ..causes.protocol import FittedCause, Setting
from ..result import Evidence
from ..thresholds.checks import SPRING_RESONANCE


def resonance_evidence(cause: str, at: Setting, solved: FittedCause) -> tuple[Evidence, ...]:
    """Give how many times the stiffness is that of the resonance; nothing of any other cause.

    Nor of a link whose inertia the fit leaves without a size.
    """
    if cause != JointElasticity.id:
        return ()
    gear = Gear(at.operating_point, at.joint, at.scalars.get("motor_inertia", 0.0))
    inertia = float(np.mean(gear.inertia(at.dataset.state)))
    if inertia <= 0.0:
        return ()
    angular = 2.0 * np.pi * solved.scalars["resonance_hz"]
    ratio = 1.0 / (float(solved.values[0]) * angular**2 * inertia)
    return (
        Evidence(
            f"Stiffness over that which its resonance of {solved.scalars['resonance_hz']:.3g} Hz and the moved "
            f"inertia give; a finding beyond {SPRING_RESONANCE.times:g} or below "
            f"{1.0 / SPRING_RESONANCE.times:.2g} is doubtful: something else swings",
            "stiffness over resonance",
            ratio,
        ),
    )


def contradicts_resonance(evidence: tuple[Evidence, ...], solved: FittedCause) -> bool:
    """Tell whether a stiffness differs from that of its resonance, and by more than both are uncertain."""
    if not evidence:
        return False
    stiffness = float(solved.covariance[0, 0] ** 0.5 / solved.values[0])
    resonance = 2.0 * solved.deviations.get("resonance_hz", 0.0) / solved.scalars["resonance_hz"]
    off = abs(float(np.log(evidence[0].value)))
    least = SPRING_RESONANCE.deviations * float(np.hypot(stiffness, resonance))
    return off > max(float(np.log(SPRING_RESONANCE.times)), least)
