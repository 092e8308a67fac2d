"""Lower what a diagnosis claims while robot and log do not fit each other.

A cause is a small correction of a model that fits. Beside a conflict that is open, or a model that leaves
more than half of a joint's torque, the likeliest small correction is seldom the reason.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np

from ...arrays import SampleMask, Samples
from ...log.defects.unsigned import UNKNOWN_SIGN
from ..causes.torque_dead_zone import TorqueDeadZone
from ..causes.torque_gain import TorqueGain
from ..dataset.dataset import Dataset
from ..result import Diagnosis, Evidence, Finding, UnnamedPattern
from ..thresholds.checks import CONFIDENCE, RESIDUAL, VERDICT
from ..thresholds.dataset import BAND


@dataclass(frozen=True)
class SetupDoubts:
    """Hold what is in doubt about how robot and logs belong together."""

    is_open: bool = False
    """Whether they disagree in something that was not corrected."""
    causes: frozenset[str] = frozenset()
    """Causes that stay doubtful although what disagreed was corrected."""
    promising: float = 0.0
    """By how much the mean logarithm of the joints' errors would fall under another set-up that is not clear
    enough to be called wrong. Where all findings gain less, it is the better explanation."""
    confidence: float = 1.0
    """Probability of the corrections that were applied. No cause is surer than its set-up."""


def with_reservations(found: Diagnosis, setup: SetupDoubts, *, doubted: bool) -> Diagnosis:
    """Limit confidences and verdict.

    Parameters
    ----------
    doubted
        Whether the identification contradicts the model, the logs or itself.
    """
    failed = setup.is_open or any(_joints_not_fitted(found))
    findings = tuple(
        as_doubtful(finding) if failed or finding.cause in setup.causes else finding
        for finding in found.findings
    )
    findings = tuple(
        _as_sure_as(setup.confidence, finding) for finding in beside_another_setup(findings, setup.promising)
    )
    claims_nothing = found.verdict == "nothing_found" and (failed or doubted)
    explains = any(finding.confidence > CONFIDENCE.doubtful for finding in findings)
    claims_too_much = found.verdict == "causes_found" and not explains
    return replace(
        found,
        findings=findings,
        verdict="unexplained" if claims_nothing or claims_too_much else found.verdict,
        # What cannot be identified is known at a good fit only, and the model does not fit.
        not_identifiable=() if failed else found.not_identifiable,
    )


def beside_dead_zones(findings: Sequence[Finding], *, restored: bool) -> list[Finding]:
    """Limit findings on joints of which a dead zone that stays accounts for more than they explain.

    What the channel keeps back is a torque of the load and of the direction of motion, as friction is, and
    comes and goes, as contacts do. A transient cause acts on all joints before its own. A gain is one against
    the other joints: on which of them the torque is too small no log tells. A channel that may have a zone
    limits all findings on its joint.
    """
    zones = _zones(findings, restored=restored)

    def limited(finding: Finding) -> Finding:
        reach = zones if finding.cause == TorqueGain.id else _reach(finding)
        spoilt = max((zones.get(joint, 0.0) for joint in reach), default=0.0)
        return as_doubtful(finding) if spoilt > finding.explained_fraction else finding

    return [limited(finding) for finding in findings]


def _zones(findings: Sequence[Finding], *, restored: bool) -> dict[int, float]:
    """Give, by joint, the share of the residual that a dead zone explains; all of it by a doubtful one."""
    zones = [one for one in findings if one.cause == TorqueDeadZone.id]
    known = {} if restored else {one.joints[0]: one.explained_fraction for one in zones}
    return known | {one.joints[0]: np.inf for one in zones if one.confidence <= CONFIDENCE.doubtful}


def _reach(finding: Finding) -> Sequence[int]:
    """List the joints, from 1, whose torques bear on a finding; none on one that the search did not make."""
    if finding.member is None:
        return ()
    return range(1, max(finding.joints) + 1) if finding.member.cause.traits.transient else finding.joints


def beside_mixed_channels(
    findings: Sequence[Finding], unnamed: UnnamedPattern | None, most: float
) -> list[Finding]:
    """Limit what a search found where torque channels read each other by more than any of it explains.

    No channel then holds the torque of its joint alone, so that none of them shows a cause.

    Parameters
    ----------
    most
        Largest likelihood ratio statistic of the findings.
    """
    mixed = unnamed is not None and unnamed.mixes_channels and unnamed.statistic > most
    return [as_doubtful(finding) if mixed and finding.member is not None else finding for finding in findings]


def beside_unknown_signs(findings: Sequence[Finding], dataset: Dataset) -> list[Finding]:
    """Limit what a search found while torques of some joints may be magnitudes, as others' in the log are.

    What a magnitude lacks looks like a gain or a friction of its joint, and enters what all joints share.
    """
    joints = sorted(_of_unknown_sign(dataset))
    evidence = Evidence(
        "Joints whose torque may be a magnitude, as other joints' in the log are: "
        f"{', '.join(map(str, joints))}. No cause is sure beside them",
        "torques of unknown sign",
        float(len(joints)),
    )
    return [
        as_doubtful(replace(finding, evidence=(*finding.evidence, evidence)))
        if joints and finding.member is not None
        else finding
        for finding in findings
    ]


def _of_unknown_sign(dataset: Dataset) -> set[int]:
    """Give the joints, from 1, whose torque may be a magnitude in some log."""
    defects = chain.from_iterable(motion.log.defects for motion in dataset.motions)
    return {defect.joint for defect in defects if defect.kind == UNKNOWN_SIGN and defect.joint}


def beside_another_setup(findings: Sequence[Finding], promising: float) -> tuple[Finding, ...]:
    """Limit findings that enter the model where another set-up explains more than all findings together.

    Parameters
    ----------
    promising
        By how much that lowers the mean logarithm of the joints' errors.
    """
    gained = sum(map(_mean_log_gain, findings))
    evidence = Evidence(
        "By how much another set-up of robot and log would lower the mean logarithm of the joints' errors: "
        f"more than all findings do ({gained:.2g}); the log does not decide for it",
        "another set-up",
        promising,
    )
    return tuple(
        as_doubtful(replace(finding, evidence=(*finding.evidence, evidence)))
        if promising > max(gained, 0.0) and finding.member is not None
        else finding
        for finding in findings
    )


def _mean_log_gain(finding: Finding) -> float:
    """Give by how much a finding lowers the mean logarithm of the joints' errors on held-out rows."""
    if finding.gain is None:
        return 0.0
    least = np.finfo(float).tiny  # a joint that stands leaves nothing, with and without
    before, after = (np.maximum(rms, least) for rms in (finding.gain.before, finding.gain.after))
    return float(np.mean(np.log(before / after)))


def as_doubtful(finding: Finding) -> Finding:
    """Give a finding no more confidence than a doubtful one may have."""
    return _as_sure_as(CONFIDENCE.doubtful, finding)


def _as_sure_as(most: float, finding: Finding) -> Finding:
    return finding if finding.confidence <= most else replace(finding, confidence=most)


def _joints_not_fitted(found: Diagnosis) -> Iterator[int]:
    """Give the joints that keep more than half of their RMS torque, and not as noise.

    Either the residual can be predicted from the motion, or it stays from cycle to cycle of the band. Where
    positions are no positions, nothing in the log predicts it, and it is as slow as the motion all the same.
    """
    structured = {share.joint for share in found.predictable if share.interval[0] > VERDICT.unexplained_share}
    for joint, usable in enumerate(found.dataset.usable.T, start=1):
        left, torque = (
            np.where(usable, series[:, joint - 1], 0.0)
            for series in (found.residual_after, found.dataset.torque)
        )
        rows = max(int(np.count_nonzero(usable)), 1)
        most = RESIDUAL.failed**2 * float(np.sum(torque**2)) / rows
        is_structured = joint in structured and float(np.sum(left**2)) / rows > most
        if is_structured or _persisting(found.dataset, left, usable) > most:
            yield joint


def _persisting(dataset: Dataset, left: Samples, usable: SampleMask) -> float:
    """Give the mean square of what a residual keeps over a cycle of the band, which white noise does not."""
    lag = int(np.ceil(BAND.rows))
    products = [left[one.rows][lag:] * left[one.rows][:-lag] for one in dataset.stretches]
    pairs = [usable[one.rows][lag:] & usable[one.rows][:-lag] for one in dataset.stretches]
    return float(sum(map(np.sum, products)) / max(sum(map(np.count_nonzero, pairs)), 1))
