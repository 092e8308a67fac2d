"""Tell torques that were smoothed forwards and backwards before they were logged.

A moving mean, a polynomial filter or a filter that is run in both directions takes what is quick out of a
torque, before its cause as after it. No cause on the list does so: a filter in a drive is late. What such a
torque lacks looks like a spring, a delay, or friction that builds up. A recorder smooths all its channels
alike, so that the joints agree: each lacks about the same share of what a moving mean takes away.
Source: Oppenheim & Willsky, Signals and Systems (1997), ch. 3, on filters of zero phase.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...arrays import JointMarks, JointVector
from ..result import Evidence, Finding
from ..search.fitter import HypothesisFitter
from ..search.hypothesis import Candidate, Hypothesis
from ..thresholds.checks import CONFIDENCE, SMOOTHED
from .lack_of_fit import smoothed_candidates
from .reservations import as_doubtful
from .unnamed_pattern import moving_means

QUICK = ("velocity", "other_velocity", "travel", "load_jerk", "torque_rate")
"""Coordinates of causes that act at once where a joint turns round or its torque changes."""


@dataclass(frozen=True, eq=False)
class Smoothing:
    """Hold, joint by joint, what the torques lack of what a moving mean takes away."""

    candidates: tuple[Candidate, ...]
    """The moving mean on each joint."""
    seconds: float
    """Length of the moving mean."""
    shares: JointVector
    deviations: JointVector
    """One where all of it is lacking; infinite deviations where a joint tells nothing."""
    statistic: float
    """Score statistic of all joints."""

    @property
    def is_clear(self) -> bool:
        """Tell whether most joints of which the share is known lack much of it, and several do."""
        known = self.deviations < SMOOTHED.unknown * np.maximum(np.abs(self.shares), 1.0)
        count = int(np.count_nonzero(known & self._lacking))
        return count >= max(SMOOTHED.joints, SMOOTHED.most * int(np.count_nonzero(known)))

    @property
    def length(self) -> float:
        """Give the length of a moving mean, s, that takes all of it away: slow changes lose by its square."""
        return float(self.seconds * np.sqrt(np.median(self.shares[self._lacking])))

    @property
    def _lacking(self) -> JointMarks:
        return np.asarray(self.shares > SMOOTHED.share)

    @property
    def evidence(self) -> Evidence:
        """State how many joints show it."""
        return Evidence(
            "Joints whose torque lacks what is quick in the predicted one, as if a moving mean over "
            f"{1e3 * self.length:.2g} ms had smoothed it forwards and backwards, or as if positions were "
            "noisier than it seems. What is lacking looks like other causes: log what is measured",
            "smoothed torques",
            float(np.count_nonzero(self._lacking)),
        )


def smoothing(fitter: HypothesisFitter, chosen: Hypothesis) -> Smoothing:
    """Give the likeliest smoothing of all torques beside what a search found."""
    return max((_over(fitter, chosen, seconds) for seconds in moving_means()), key=_statistic)


def _over(fitter: HypothesisFitter, chosen: Hypothesis, seconds: float) -> Smoothing:
    candidates = smoothed_candidates(fitter, seconds)
    scores = fitter.score(chosen, candidates)
    variances = np.array([float(one.covariance[0, 0]) if one.freedom else np.inf for one in scores])
    shares = np.array([float(one.values[0]) for one in scores])
    return Smoothing(candidates, seconds, shares, np.sqrt(variances), sum(one.statistic for one in scores))


def _statistic(found: Smoothing) -> float:
    return found.statistic


def beside_smoothing(
    findings: Sequence[Finding], fitter: HypothesisFitter, chosen: Hypothesis
) -> list[Finding]:
    """Limit what torques lack that were smoothed, which is sought where anything that a search found is sure.

    A finding of which the smoothing takes no part is none of what smoothing leaves. One that acts at once is
    doubtful all the same.
    """
    sure = any(finding.member and finding.confidence > CONFIDENCE.doubtful for finding in findings)
    if not sure or not (found := smoothing(fitter, chosen)).is_clear:
        return list(findings)
    beside = fitter.fit((*chosen.members, *found.candidates), chosen)
    return [
        finding
        if finding.member is None or _stays(fitter, finding.member, chosen, beside)
        else as_doubtful(replace(finding, evidence=(*finding.evidence, found.evidence)))
        for finding in findings
    ]


def _stays(fitter: HypothesisFitter, member: Candidate, chosen: Hypothesis, beside: Hypothesis) -> bool:
    """Tell whether a member stands for the same torque where smoothed torques are in the model as well.

    It may change by its standard deviation and a share of it, in squares.
    """
    if member.cause.coordinate in QUICK:
        return False
    index, (columns,) = chosen.members.index(member), fitter.columns([member])
    alone, left = (found.solved(index) for found in (chosen, beside))
    products = sum(own.T @ own for own in columns.values())
    changed, whole = (
        float(values @ products @ values) for values in (left.values - alone.values, alone.values)
    )
    unknown = float(np.trace(products @ alone.covariance))
    return changed <= unknown + SMOOTHED.changed**2 * whole
