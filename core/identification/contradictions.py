"""Say in what the model does not fit the logs, in sentences with numbers.

An optimum exists even for wrong signs, units or gravity. These show in the cost of the consistency constraint
and in the residual.
"""

import numpy as np

from ..arrays import JointVector
from ..validation.quality import quality
from .result import Identification

HIGH_COST = 1.25
"""Constraints that raise the squared error by more than a quarter contradict the log."""
POOR_PREDICTION_PERCENT = 50.0
HELD_OUT_OVER_FITTED = 2.0
CERTAIN = 3.0
"""A value this many standard deviations from zero has a significant sign."""


def contradictions(found: Identification) -> tuple[str, ...]:
    """List the warnings that say that the model does not fit the log."""
    return (*_cost(found), *_signs(found), *_unexplained(found), *_held_out(found))


def has_impossible_joint(found: Identification) -> bool:
    """Tell whether only physically inconsistent bodies could follow a joint's torque well enough.

    The constraint then costs most of it: robot and log disagree, and not in a small correction.
    """
    costly = _joint_cost(found) > HIGH_COST
    judged = found.validation or found.fit
    return any(
        costly[score.joint - 1] and quality(score.nrmse_of_rms_percent) == "failed" for score in judged
    )


def _cost(found: Identification) -> list[str]:
    estimate = found.estimate
    cost = estimate.cost_ratio
    if cost <= HIGH_COST:
        return []
    joints = ", ".join(str(joint + 1) for joint in np.flatnonzero(_joint_cost(found) > HIGH_COST))
    sentence = (
        f"The consistency constraint raises the squared error by a factor of {cost:.3g} over least "
        f"squares, mainly on joints {joints or 'none alone'}: the log and the description may disagree "
        "in the sign of a torque, in units or in gravity, or the torque was measured elsewhere than modelled"
    )
    return [sentence]


def _joint_cost(found: Identification) -> JointVector:
    observation, estimate = found.observation, found.estimate
    pairs = zip(observation.joint_factors(), observation.columns_of, strict=True)
    return np.array(
        [
            factor.residual_square(estimate.base[columns])
            / max(
                factor.residual_square(estimate.unconstrained[columns]), 1e-12 * factor.torque_square, 1e-300
            )
            for factor, columns in pairs
        ]
    )


def _signs(found: Identification) -> list[str]:
    # Least squares leaves a smaller residual than the estimate that the deviations were taken from.
    deviation = found.precision.standard_deviation / np.sqrt(found.estimate.cost_ratio)
    known = deviation > 0.0
    ratio = np.divide(found.estimate.unconstrained, deviation, out=np.zeros_like(deviation), where=known)
    negative = {
        found.base.names[row]
        for row in range(len(found.base.kept))
        if found.base.parameter(row).symbol in {"FV", "FC"} and ratio[row] < -CERTAIN
    }
    joints = sorted({name[2:] for name in negative}, key=int)
    both = [joint for joint in joints if {f"FV{joint}", f"FC{joint}"} <= negative]
    return [
        f"Least squares finds negative viscous and Coulomb friction on joint {joint}, each more than "
        f"{CERTAIN:g} standard deviations below zero: its torque may have the opposite sign"
        for joint in both
    ]


def _unexplained(found: Identification) -> list[str]:
    """Name the joints on which most is left; of all of them, what that may mean."""
    poor = [score for score in found.fit if score.nrmse_of_rms_percent > POOR_PREDICTION_PERCENT]
    if len(poor) == len(found.fit) > 1:
        left = sorted(score.nrmse_of_rms_percent for score in poor)
        sentence = (
            f"The model leaves {left[0]:.3g} to {left[-1]:.3g} % of every joint's RMS torque unexplained: "
            "positions and torques may be of different runs or robots, or a channel is another signal"
        )
        return [sentence]
    return [
        f"The model leaves {score.nrmse_of_rms_percent:.3g} % of joint {score.joint}'s RMS torque unexplained"
        for score in poor
    ]


def _held_out(found: Identification) -> list[str]:
    fitted, held_out = found.fit_total_percent, found.validation_total_percent
    if not found.validation or held_out <= HELD_OUT_OVER_FITTED * fitted:
        return []
    sentence = (
        f"The error on held-out data ({held_out:.3g} %) is {held_out / fitted:.3g} times the error on fitted "
        f"data ({fitted:.3g} %): the held-out motion may excite what the fitted motion does not"
    )
    return [sentence]
