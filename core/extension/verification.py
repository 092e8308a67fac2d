"""Verify causes whose gain the search leaves in doubt: identify again with them, one by one.

A search uses a wide bandwidth, in which slow torque has little weight and much of the rest is noise. A user
gets an identification at the bandwidth of the motion. Where that predicts held-out motion significantly
better, the cause enters the model.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

from ..diagnosis.checks.reservations import as_doubtful
from ..diagnosis.result import Diagnosis, Evidence, Finding
from ..errors import SolverError
from .cure import enters
from .gain import JointGain

Answer = TypeVar("Answer")
"""What an identification gives."""


def verify(
    diagnosis: Diagnosis,
    tried: Callable[[Diagnosis], Answer],
    gained: Callable[[Answer, Answer], tuple[JointGain, ...]],
) -> tuple[Diagnosis, Answer | None]:
    """Mark the findings without which the held-out blocks are predicted significantly worse; doubt the rest.

    Gives the last identification with all verified findings as well, if there was one.

    Parameters
    ----------
    tried
        Identifies with all verified findings.
    gained
        Gives the gain of one identification over another on the held-out blocks.
    """
    now: Answer | None = None
    for index, finding in enumerate(diagnosis.findings):
        if finding.member is None or enters(finding):
            continue
        findings = list(diagnosis.findings)
        findings[index] = replace(finding, verified=True)
        trial = replace(diagnosis, findings=tuple(findings))
        try:
            now = tried(diagnosis) if now is None else now
            then = tried(trial)
        except SolverError:  # with it there is no answer
            continue
        if shown := _gain_evidence(finding, gained(now, then)):
            findings[index] = replace(finding, verified=True, evidence=(*finding.evidence, *shown))
            diagnosis, now = replace(diagnosis, findings=tuple(findings)), then
    return replace(diagnosis, findings=tuple(map(_doubted_unless_shown, diagnosis.findings))), now


def _doubted_unless_shown(finding: Finding) -> Finding:
    """Limit the confidence of a finding that no held-out row shows: likely by its statistics alone.

    Statistics take the rest of the model for true. Where something else is wrong, a cause may stand for a
    part of that, significantly, and predict nothing.
    """
    return finding if finding.member is None or enters(finding) else as_doubtful(finding)


def _gain_evidence(finding: Finding, found: tuple[JointGain, ...]) -> tuple[Evidence, ...]:
    """Give the evidence per joint that is predicted better; none where the others lose as much."""
    if sum(gain.improvement_percent for gain in found) <= 0.0:
        return ()
    return tuple(
        Evidence(
            f"Reduction of the error of joint {gain.joint} on held-out motion, in percent, when the robot is "
            f"identified with it; 95 % interval {gain.interval_95[0]:.1f} to {gain.interval_95[1]:.1f}",
            "gain identified",
            gain.improvement_percent,
        )
        for gain in found
        if gain.joint in finding.joints and gain.interval_95 is not None and gain.interval_95[0] > 0.0
    )
