"""Tell whether a fit gives reason to ask if description and log belong together.

An optimum exists even for wrong signs, units or gravity. These show in the cost of the consistency constraint
and in the residual.
"""

from ..identification.identify import Fit
from ..log.model import JointLog
from .thresholds import DOUBT


def is_doubtful(fit: Fit, logs: tuple[JointLog, ...]) -> bool:
    """Tell whether a plain fit or the numbers of a log are in doubt."""
    return fit.estimate.cost_ratio > DOUBT.cost or _unexplained(fit) or any(map(_has_doubtful_unit, logs))


def is_worse_than_none(corrected: Fit) -> bool:
    """Tell whether a fit after a correction leaves more of a joint than its whole torque.

    Trials weight joints by what each leaves. Where a correction made one joint's torque tiny beside others,
    bodies that these need give it many times as much, and such a trial is no robot's.
    """
    return _leaves(corrected, 1.0, None)


def _has_doubtful_unit(log: JointLog) -> bool:
    """Tell whether positions or efforts are of an unusual size; a good fit is no excuse."""
    return any(defect.kind == "implausible_unit" and defect.channel != "time" for defect in log.defects)


def _unexplained(fit: Fit) -> bool:
    """Tell whether much is left of a joint's torque, on fitted or on held-out blocks."""
    parts = fit.observation.parts(fit.problem.held_out)
    return any(_leaves(fit, DOUBT.unexplained, blocks) for blocks in parts if blocks)


def _leaves(fit: Fit, share: float, blocks: tuple[int, ...] | None) -> bool:
    """Tell whether a share of a joint's RMS torque is left on some blocks, or on all."""
    return any(
        factor.residual_square(fit.estimate.base[columns]) > share**2 * factor.torque_square
        for factor, columns in zip(
            fit.observation.joint_factors(blocks), fit.observation.columns_of, strict=True
        )
    )
