"""Say what a reader should doubt about an identification that succeeded, in sentences with numbers.

A programme that ends at an optimum has answered the question it was given; whether the question made sense
(signs, units, gravity, a motion that excites) shows in what the answer cost and what it leaves unexplained.
"""

import numpy as np

from ..arrays import JointVector, Mask
from ..estimate.estimate import Estimate
from .result import Identification

HIGH_PRICE = 1.25
"""Constraints that raise the squared error by more than a quarter are at odds with the log."""
POOR_PREDICTION_PERCENT = 50.0
UNSEEN_OVER_SEEN = 2.0
CERTAIN = 3.0
"""A value this many deviations from zero has a sign."""


def doubts(found: Identification) -> tuple[str, ...]:
    """List what does not look right."""
    return (*_price(found), *_signs(found), *_unexplained(found), *_unseen(found), *_left_open(found))


def _price(found: Identification) -> list[str]:
    estimate = found.estimate
    price = _price_ratio(estimate)
    if price <= HIGH_PRICE:
        return []
    joints = ", ".join(str(joint + 1) for joint in np.flatnonzero(_joint_price(found) > HIGH_PRICE))
    sentence = (
        f"A robot that can exist fits {price:.3g} times worse (squared error) than plain least squares, "
        f"most on joints {joints or 'none alone'}: the log and the description may disagree in the sign of a "
        "torque, in units, in gravity, or the torque was not measured where the model has it"
    )
    return [sentence]


def _price_ratio(estimate: Estimate) -> float:
    return estimate.objective / max(estimate.objective_unconstrained, np.finfo(float).tiny)


def _joint_price(found: Identification) -> JointVector:
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
    deviation = found.precision.standard_deviation / np.sqrt(_price_ratio(found.estimate))
    negative = {
        found.base.names[row]: found.estimate.unconstrained[row] / deviation[row]
        for row in range(len(found.base.kept))
        if found.base.parameter(row).symbol in {"FV", "FC"} and np.isfinite(deviation[row])
    }
    joints = sorted({name[2:] for name, ratio in negative.items() if ratio < -CERTAIN}, key=int)
    both = [j for j in joints if all(negative.get(f"{s}{j}", 0.0) < -CERTAIN for s in ("FV", "FC"))]
    return [
        f"Least squares finds negative viscous and Coulomb friction on joint {joint}, each more than "
        f"{CERTAIN:g} deviations below zero: its torque may be logged with the opposite sign"
        for joint in both
    ]


def _unexplained(found: Identification) -> list[str]:
    return [
        f"The model leaves {score.nrmse_of_rms_percent:.3g} % of joint {score.joint}'s rms torque unexplained"
        for score in found.fit
        if score.nrmse_of_rms_percent > POOR_PREDICTION_PERCENT
    ]


def _unseen(found: Identification) -> list[str]:
    seen, unseen = found.fit_total_percent, found.validation_total_percent
    if not found.validation or unseen <= UNSEEN_OVER_SEEN * seen:
        return []
    spiked = _spiked_where_held_out(found)
    outliers = (
        f"outliers of the torque, which count in full, lie there (joint {spiked}), or " if spiked else ""
    )
    sentence = (
        f"The error on held-out data ({unseen:.3g} %) is {unseen / seen:.3g} times that on fitted data "
        f"({seen:.3g} %): {outliers}the held-out motion may visit what the fitted motion does not excite"
    )
    return [sentence]


def _spiked_where_held_out(found: Identification) -> str:
    """Name the joints whose torque has outliers in blocks that were held out."""
    joints = {
        defect.joint
        for block in found.observation.blocks
        if (block.log, block.number) in found.held_out
        for defect in found.logs[block.log].defects
        if (defect.kind, defect.channel) == ("outliers", "torque") and defect.joint is not None
        if any(start <= block.end and end >= block.start for start, end in defect.intervals)
    }
    return ", ".join(str(joint) for joint in sorted(joints))


def _left_open(found: Identification) -> list[str]:
    is_open = ~np.isfinite(found.precision.standard_deviation)
    silent = np.diag(found.precision.information) == 0.0
    sentences = []
    if silent.any():
        sentences.append(
            f"The motion does not excite {_names(found, silent)}: their values come from the prior alone"
        )
    if (is_open & ~silent).any():
        sentences.append(
            f"The motion cannot tell {_names(found, is_open & ~silent)} apart from each other: "
            "only combinations of them are known, the prior chooses among these"
        )
    return sentences


def _names(found: Identification, marked: Mask) -> str:
    rows = np.flatnonzero(marked)
    more = f" and {len(rows) - 10} more" if len(rows) > 10 else ""
    return ", ".join(found.base.names[row] for row in rows[:10]) + more
