"""Warn of torques that show no friction: a model or a simulation computed them.

Some controllers log, beside what they measure, the torque that their own model asks for; simulators log the
torque of bodies without friction. Either fits a rigid model very well, and is no evidence of the robot.
"""

import numpy as np

from ..arrays import JointVector, Mask
from ..regressor.factor import REGRESSOR, TARGET
from .result import Identification

FRICTION = ("FV", "FC")
FRICTIONLESS = 0.01
"""Share of the RMS torque below which a joint shows no friction. On six measured robots the median over the
joints is 0.11 to 0.97, on torques computed from two of their descriptions 1e-5 and less."""
EXPLAINED = 0.25
"""Share of a joint's RMS torque that the model leaves at most where a model may have computed it. Set by
hand, as for a fair fit: a model that fails shows no friction because it shows nothing."""
NOTHING = 1e-6
"""Share of the largest joint's RMS torque below which a joint carries none."""


def looks_computed(found: Identification) -> list[str]:
    """Warn where most joints that carry torque are explained, and without the friction that the model has."""
    rubs = np.array([found.base.parameter(row).symbol in FRICTION for row in range(len(found.estimate.base))])
    friction, left, torque = _sizes(found, rubs)
    carrying = torque > NOTHING * torque.max(initial=0.0)
    if not rubs.any() or not carrying.any() or np.median(left[carrying] / torque[carrying]) > EXPLAINED:
        return []
    share = float(np.median(friction[carrying] / torque[carrying]))
    if share > FRICTIONLESS:
        return []
    sentence = (
        f"Most joints show no friction (median {100.0 * share:.2g} % of the torque), as where a model or a "
        "simulation computed the torques. Measured torques or currents tell the robot; a controller's target "
        "torque tells its model"
    )
    return [sentence]


def _sizes(found: Identification, rubs: Mask) -> tuple[JointVector, JointVector, JointVector]:
    """Give, by joint, the norms of the torque of some base parameters, of what is left, and of all torque."""
    base, friction, left, torque = found.estimate.base, [], [], []
    for factor, columns in zip(found.observation.joint_factors(), found.observation.columns_of, strict=True):
        own = np.where(rubs[columns], base[columns], 0.0)
        friction.append(float(np.linalg.norm(factor.columns(REGRESSOR) @ own)))
        left.append(np.sqrt(factor.residual_square(base[columns])))
        torque.append(float(np.linalg.norm(factor.columns(TARGET))))
    return np.array(friction), np.array(left), np.array(torque)
