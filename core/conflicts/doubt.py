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


def _has_doubtful_unit(log: JointLog) -> bool:
    """Tell whether positions or efforts are of an unusual size; a good fit is no excuse."""
    return any(defect.kind == "implausible_unit" and defect.channel != "time" for defect in log.defects)


def _unexplained(fit: Fit) -> bool:
    """Tell whether much is left of a joint's torque, on fitted or on held-out blocks."""
    observation, limit = fit.observation, DOUBT.unexplained**2
    return any(
        factor.residual_square(fit.estimate.base[columns]) > limit * factor.torque_square
        for blocks in observation.parts(fit.problem.held_out)
        if blocks
        for factor, columns in zip(observation.joint_factors(blocks), observation.columns_of, strict=True)
    )
