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
NOTHING = 1e-6
"""Share of the largest joint's RMS torque below which a joint carries none."""


def looks_computed(found: Identification) -> list[str]:
    """Warn where most joints that carry torque show no friction, though the model has it."""
    rubs = np.array([found.base.parameter(row).symbol in FRICTION for row in range(len(found.estimate.base))])
    friction, torque = _sizes(found, rubs)
    carrying = torque > NOTHING * torque.max(initial=0.0)
    if not rubs.any() or not carrying.any():
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


def _sizes(found: Identification, rubs: Mask) -> tuple[JointVector, JointVector]:
    """Give, by joint, the norms of the torque of some base parameters and of all torque."""
    base, friction, torque = found.estimate.base, [], []
    for factor, columns in zip(found.observation.joint_factors(), found.observation.columns_of, strict=True):
        own = np.where(rubs[columns], base[columns], 0.0)
        friction.append(float(np.linalg.norm(factor.columns(REGRESSOR) @ own)))
        torque.append(float(np.linalg.norm(factor.columns(TARGET))))
    return np.array(friction), np.array(torque)
