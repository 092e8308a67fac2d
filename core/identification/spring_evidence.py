"""Say by which numbers logs show the springs of joints, and refuse those that they hide."""

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


def seen_by(motions: Sequence[Motion], joint: int, low_hz: float, high_hz: float) -> dict[str, float]:
    """Give what tells whether logs show a mode."""
    seen = np.isfinite(high_hz)
    shares = [
        torque_share(_torque(motion)[:, joint], motion.log.rate_hz, low_hz, high_hz) if seen else 0.0
        for motion in motions
    ]
    return {
        "natural_hz": high_hz,
        "antiresonance_hz": low_hz,
        "rate_hz": min(motion.log.rate_hz for motion in motions),
        "torque_share_percent": 100.0 * max(shares),
    }


def _torque(motion: Motion) -> JointSeries:
    """Give the torque of the longest stretch of a motion."""
    segment = max(motion.segments, key=lambda one: one.samples)
    return segment.effort(0, segment.kept)[0]


def positions_of(problem: Problem) -> JointSeries:
    """Give some positions of every motion."""
    return np.vstack([next(motion.tiles()).state.position[::200] for motion in problem.motions])


def refuse_hidden(evidence: Mapping[int, Mapping[str, float]], reasons: Mapping[int, list[str]]) -> None:
    """Refuse springs that something hides.

    Raises
    ------
    ExcitationError
        If there is a reason for any joint (from 1).
    """
    hidden = [joint for joint, own in reasons.items() if own]
    if hidden:
        why = "; ".join(f"joint {joint}: {', '.join(reasons[joint])}" for joint in hidden)
        raise unseen(hidden, {f"joint_{joint}": dict(evidence[joint]) for joint in hidden}, why)


def unseen(joints: list[int], evidence: Mapping[str, object], why: str) -> ExcitationError:
    """Say that the logs do not show springs."""
    named = f"joint {joints[0]} is" if len(joints) == 1 else f"joints {', '.join(map(str, joints))} are"
    return ExcitationError(
        f"the logs do not show that {named} flexible: {why}",
        evidence=dict(evidence),
        remedy="leave rigid joints out of flexible_joints, or let all joints move with frequencies up to "
        f"their modes, sampled at more than {1.0 / HIGHEST_SHARE:.2g} times these",
    )
