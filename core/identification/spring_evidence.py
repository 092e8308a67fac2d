"""Say by which numbers logs show the springs of joints, and refuse those that they hide.

Only what was computed is evidence: a link without inertia has no mode, and a start has no deviations.
"""

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from ..arrays import JointSeries
from ..errors import ExcitationError
from ..estimate.problem import Problem
from ..signals.condition import Motion
from ..validation.springs_seen import HIGHEST_SHARE, torque_share

KNOWN: Final = "stiffness_deviation_percent"
"""What the deviation of a stiffness is called among its evidence."""
BAND_OVER_MODE: Final = 1.6
"""Parallel cut-off over the highest mode: the mode and what lies around it pass."""
CUTOFF: Final = "filter.cutoff_hz"
"""The option that decides what passes."""


def seen_by(motions: Sequence[Motion], joint: int, low_hz: float, high_hz: float) -> dict[str, float]:
    """Give what tells whether logs show a mode; of one that is not finite, the rate alone."""
    rate = {"rate_hz": min(motion.log.rate_hz for motion in motions)}
    if not np.isfinite(high_hz):
        return rate
    shares = [
        torque_share(_torque(motion)[:, joint], motion.log.rate_hz, low_hz, high_hz) for motion in motions
    ]
    return {
        "natural_hz": high_hz,
        "antiresonance_hz": low_hz,
        **rate,
        "torque_share_percent": 100.0 * max(shares),
    }


def _torque(motion: Motion) -> JointSeries:
    """Give the torque of the longest stretch of a motion."""
    segment = max(motion.segments, key=lambda one: one.samples)
    return segment.effort(0, segment.kept)[0]


def positions_of(problem: Problem) -> JointSeries:
    """Give some positions of every motion."""
    return np.vstack([next(motion.tiles()).state.position[::200] for motion in problem.motions])


def refuse_hidden(
    evidence: Mapping[int, Mapping[str, float]],
    reasons: Mapping[int, Sequence[str]],
    cutoff_hz: float | None = None,
) -> None:
    """Refuse springs that something hides.

    Parameters
    ----------
    cutoff_hz
        The parallel filter's cut-off, where it was asked for.

    Raises
    ------
    ExcitationError
        If there is a reason for any joint (from 1).
    """
    told = {joint: " and ".join(own) for joint, own in reasons.items() if own}
    if not told:
        return
    error = unseen(list(told), {f"joint_{joint}": dict(evidence[joint]) for joint in told}, _joined(told))
    mode = max(evidence[joint].get("natural_hz", 0.0) for joint in told)
    raise error if cutoff_hz is None or mode <= cutoff_hz else misfiltered(error, cutoff_hz, mode)


def _joined(told: Mapping[int, str]) -> str:
    """Say what hides which joint; of one joint, which is named already, what hides it."""
    return "; ".join(told.values() if len(told) == 1 else (f"joint {at}: {own}" for at, own in told.items()))


def unseen(joints: Sequence[int], evidence: Mapping[str, object], why: str) -> ExcitationError:
    """Say that the logs do not show springs."""
    return ExcitationError(
        f"the logs do not show that {_are(joints)} flexible: {why}",
        evidence=dict(evidence),
        remedy="leave rigid joints out of flexible_joints, or let all joints move with frequencies up to "
        f"their modes, sampled at more than {1.0 / HIGHEST_SHARE:.2g} times these",
    )


def misfiltered(error: ExcitationError, cutoff_hz: float, mode_hz: float) -> ExcitationError:
    """Say that the filter that was asked for hides springs, whose highest mode is given."""
    apart = f"below {BAND_OVER_MODE:g} times" if cutoff_hz < BAND_OVER_MODE * mode_hz else "far above"
    return ExcitationError(
        f"{error.cause}; {CUTOFF} is {cutoff_hz:.4g} Hz, {apart} the mode at {mode_hz:.4g} Hz",
        evidence={
            "pointer": f"/options/{CUTOFF.replace('.', '/')}",
            "cutoff_hz": cutoff_hz,
            "mode_hz": mode_hz,
            **error.evidence,
        },
        remedy=f"leave {CUTOFF} out, so that the filter follows the modes, or give about"
        f" {BAND_OVER_MODE * mode_hz:.3g} Hz",
    )


def _are(joints: Sequence[int]) -> str:
    """Name joints, with the verb.

    Examples
    --------
    >>> _are([2]), _are([1, 3])
    ('joint 2 is', 'joints 1 and 3 are')
    """
    *others, last = map(str, joints)
    return f"joints {', '.join(others)} and {last} are" if others else f"joint {last} is"
