"""Compare a spring's stiffness with the one that its resonance and the link's inertia give.

A link on a spring resonates at the square root of stiffness over inertia. Whatever else swings with the arm
(its base, a liquid, a load that hangs) has another mass than the link: what it adds to the torque gives a
stiffness that does not belong to its rate. Source: Spong, J. Dyn. Sys. Meas. Control 109, 1987.
"""

from collections.abc import Sequence

import numpy as np

from ...dynamics.gear import Gear
from ..causes.joint_elasticity import JointElasticity
from ..causes.protocol import FittedCause, Setting
from ..result import Evidence, Finding
from ..thresholds.checks import CONFIDENCE, SPRING_RESONANCE
from .one_size import has_several_sizes
from .reservations import as_doubtful

STATISTIC = "stiffness over resonance"
"""Name of the statistic: the ratio of the two stiffnesses."""


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
    rate_hz = solved.scalars["resonance_hz"]
    ratio = 1.0 / (float(solved.values[0]) * (2.0 * np.pi * rate_hz) ** 2 * inertia)
    return (
        Evidence(
            f"Stiffness over that which its resonance of {rate_hz:.3g} Hz and the moved inertia give; a "
            f"finding beyond {SPRING_RESONANCE.times:g} or below "
            f"{1.0 / SPRING_RESONANCE.times:.2g} is doubtful: something else swings",
            STATISTIC,
            ratio,
        ),
    )


def beside_what_swings(findings: Sequence[Finding]) -> tuple[list[Finding], bool]:
    """Limit findings beside one that stands for something else, and explains more.

    That is a spring whose stiffness is not that of its resonance, or one number that has several sizes. What
    it leaves of the other thing may look like any other cause, on all joints.

    Returns
    -------
    tuple
        The findings, and whether none explains more than such a finding.
    """
    most = max(
        (finding.explained_fraction for finding in findings if _stands_for_another(finding)), default=-np.inf
    )
    more = [finding.explained_fraction > most for finding in findings]
    limited = [
        finding if clear or finding.member is None else as_doubtful(finding)
        for finding, clear in zip(findings, more, strict=True)
    ]
    return limited, bool(findings) and not any(more)


def _stands_for_another(finding: Finding) -> bool:
    """Tell whether a finding has several sizes, or is doubtful and its stiffness not of its resonance."""
    if has_several_sizes(finding):
        return True
    off = (abs(float(np.log(each.value))) for each in finding.evidence if each.statistic == STATISTIC)
    return finding.confidence <= CONFIDENCE.doubtful and any(
        size > float(np.log(SPRING_RESONANCE.times)) for size in off
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
