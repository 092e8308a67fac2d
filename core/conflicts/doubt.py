"""Tell whether a fit gives reason to ask if description and log belong together.

An optimum exists even for wrong signs, units or gravity. These show in the cost of the consistency constraint
and in the residual.
"""

from ..identification.identify import Fit
from ..log.model import JointLog
from .thresholds import DOUBT


def is_doubtful(fit: Fit, logs: tuple[JointLog, ...]) -> bool:
    """Tell whether a plain fit or the numbers of a log are in doubt."""
    doubted = fit.estimate.cost_ratio > DOUBT.cost or _leaves(fit, DOUBT.unexplained)
    return doubted or any(map(_has_doubtful_unit, logs))


def is_worse_than_none(corrected: Fit) -> bool:
    """Tell whether a fit after a correction leaves more of a joint than its whole torque.

    Trials weight joints by what each leaves. Where a correction made one joint's torque tiny beside others,
    bodies that these need give it many times as much, and such a trial is no robot's.
    """
    return _leaves(corrected, 1.0)


def _has_doubtful_unit(log: JointLog) -> bool:
    """Tell whether positions or efforts are of an unusual size; a good fit is no excuse."""
    return any(defect.kind == "implausible_unit" and defect.channel != "time" for defect in log.defects)


def _leaves(fit: Fit, share: float) -> bool:
    """Tell whether a share of a joint's RMS torque is left, on fitted or on held-out blocks."""
    observation, limit = fit.observation, share**2
    return any(
        factor.residual_square(fit.estimate.base[columns]) > limit * factor.torque_square
        for blocks in observation.parts(fit.problem.held_out)
        if blocks
        for factor, columns in zip(observation.joint_factors(blocks), observation.columns_of, strict=True)
    )
