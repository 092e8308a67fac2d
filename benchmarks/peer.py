"""Write the same equations with pinocchio, sample by sample, as most identification tools do.

pinocchio is told the robot link by link; its inertial parameters are matched to ours by name, because the
orders differ.
"""

from typing import Any, Final

import numpy as np
import pinocchio as pin

from veritorque.core.reduction.base import BaseModel
from veritorque.core.robot.model import RobotModel
from veritorque.core.signals.state import MotionState

SYMBOLS: Final = ("M", "MX", "MY", "MZ", "XX", "XY", "YY", "XZ", "YZ", "ZZ")
"""pinocchio's order of a body's parameters."""


def pinocchio_model(robot: RobotModel) -> Any:  # noqa: ANN401 (pinocchio publishes no types)
    """Build a chain or tree of the robot's joints; bodies do not matter to a regressor."""
    model = pin.Model()
    model.gravity = pin.Motion(np.asarray(robot.gravity), np.zeros(3))
    numbers = [0]
    for link in robot.links:
        joint = pin.JointModelRZ() if link.kind == "revolute" else pin.JointModelPZ()
        placement = pin.SE3(np.asarray(link.rotation), np.asarray(link.translation))
        numbers.append(model.addJoint(numbers[link.antecedent], joint, placement, link.name))
    return model


def regressors(model: Any, state: MotionState) -> np.ndarray:  # noqa: ANN401 (pinocchio publishes no types)
    """Call pinocchio once per sample; samples x joints x (10 links)."""
    data = model.createData()
    out = np.empty((len(state.position), model.nv, 10 * model.nv))
    samples = zip(state.position, state.velocity, state.acceleration, strict=True)
    for place, sample in enumerate(samples):
        out[place] = pin.computeJointTorqueRegressor(model, data, *sample)
    return out


def base_columns(model: Any, base: BaseModel, state: MotionState) -> np.ndarray:  # noqa: ANN401 (pinocchio publishes no types)
    """Give pinocchio's columns for the base parameters, the drives' added; samples x joints x base."""
    body = regressors(model, state)
    out = np.zeros((*state.position.shape, len(base.kept)))
    drives = {
        "IA": state.acceleration,
        "FV": state.velocity,
        "FC": np.sign(state.velocity),
        "OFF": np.ones_like(state.velocity),
    }
    for row in range(len(base.kept)):
        parameter = base.parameter(row)
        if parameter.symbol in drives:
            joint = parameter.joint - 1
            out[:, joint, row] = drives[parameter.symbol][:, joint]
        else:
            out[:, :, row] = body[:, :, 10 * (parameter.number - 1) + SYMBOLS.index(parameter.symbol)]
    return out
