"""Let causes prove themselves whose gain the search leaves in doubt: identify again with them, one by one.

A search looks at a wide band, in which slow torque counts for little and much of the rest is noise; what a
user gets is an identification at the band of the motion. Where that predicts motion it has not seen surely
better, the cause belongs to the model.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

from ..diagnosis.result import Diagnosis, Evidence, Finding
from ..errors import SolverError
from .cure import gains_surely
from .gain import JointGain

Answer = TypeVar("Answer")
"""What an identification gives."""


def proven(
    diagnosis: Diagnosis,
    tried: Callable[[Diagnosis], Answer],
    gained: Callable[[Answer, Answer], tuple[JointGain, ...]],
) -> tuple[Diagnosis, Answer | None]:
    """Mark the findings without which the held-out blocks are surely predicted worse.

    Gives, besides, what identifying with all findings then beyond doubt gave, if that was asked for.

    Parameters
    ----------
    tried
        Identifies with all findings whose gain is beyond doubt.
    gained
        Tells what one identification gains over another on the held-out blocks.
    """
    now: Answer | None = None
    for place, finding in enumerate(diagnosis.findings):
        if finding.member is None or gains_surely(finding):
            continue
        findings = list(diagnosis.findings)
        findings[place] = replace(finding, proven=True)
        trial = replace(diagnosis, findings=tuple(findings))
        try:
            now = tried(diagnosis) if now is None else now
            then = tried(trial)
        except SolverError:  # with it there is no answer
            continue
        if shown := _shown(finding, gained(now, then)):
            findings[place] = replace(finding, proven=True, evidence=(*finding.evidence, *shown))
            diagnosis, now = replace(diagnosis, findings=tuple(findings)), then
    return diagnosis, now


def _shown(finding: Finding, found: tuple[JointGain, ...]) -> tuple[Evidence, ...]:
    """Tell which of a finding's joints are surely predicted better; none where the others lose as much."""
    if sum(one.improvement_percent for one in found) <= 0.0:
        return ()
    return tuple(
        Evidence(
            f"Percent that identifying the robot with it takes from the error of joint {one.joint} on unseen "
            f"motion; 95 % interval {one.interval_95[0]:.1f} to {one.interval_95[1]:.1f}",
            "gain identified",
            one.improvement_percent,
        )
        for one in found
        if one.joint in finding.joints and one.interval_95 is not None and one.interval_95[0] > 0.0
    )
