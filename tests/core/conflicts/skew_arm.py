"""Make a small sound arm, logs of it, and a table of a log as a recorder writes it."""

from pathlib import Path

import numpy as np

from tests.core.estimate.worlds import swing, true_parameters
from veritorque.core.arrays import JointSeries
from veritorque.core.dynamics.model import standard_model
from veritorque.core.log.model import JointLog
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.model import RobotModel

PLAIN = {"bootstrap": {"draws": 0}}
NAMES = ["t", *(f"q{joint}" for joint in (1, 2, 3)), *(f"tau{joint}" for joint in (1, 2, 3))]


def skew_arm() -> RobotModel:
    """Describe three skew joints."""
    row = {"type": "revolute", "theta_offset": 0.0}
    rows = [
        {**row, "alpha": 0.0, "d": 0.0, "r": 0.3},
        {**row, "alpha": -np.pi / 2, "d": 0.1, "r": 0.0},
        {**row, "alpha": 0.0, "d": 0.4, "r": 0.1},
    ]
    return robot_from_description({"name": "arm", "joints": rows})


def four_joints(**fields: object) -> RobotModel:
    """Describe four skew joints, each with some more fields."""
    row = {"type": "revolute", **fields}
    rows = [
        {**row, "alpha": 0.0, "d": 0.0, "r": 0.3, "theta_offset": 0.0},
        {**row, "alpha": -np.pi / 2, "d": 0.1, "r": 0.0, "theta_offset": 0.4},
        {**row, "alpha": 0.0, "d": 0.4, "r": 0.1, "theta_offset": -0.3},
        {**row, "alpha": np.pi / 2, "d": 0.05, "r": 0.3, "theta_offset": 0.0},
    ]
    return robot_from_description({"name": "arm", "joints": rows})


def sound_log(robot: RobotModel, seed: int = 5) -> JointLog:
    """Log a motion of always the same bodies at 100 Hz, the torques with 1 % of noise."""
    model, state = standard_model(robot), swing(3, seed=seed)
    torque = model.torque(true_parameters(model, seed=3), state)
    size = 0.01 * np.sqrt(np.mean(torque**2, axis=0))
    noise = size * np.random.default_rng(seed + 3).normal(size=torque.shape)
    return log_from_arrays(f"log {seed}", np.arange(len(torque)) / 100.0, state.position, torque + noise)


def write_table(path: Path, time: np.ndarray, position: JointSeries, torque: JointSeries) -> None:
    """Write a table whose names say neither unit nor side."""
    table = np.column_stack([time, position, torque])
    np.savetxt(path, table, delimiter=",", header=",".join(NAMES), comments="", fmt="%.8g")


def table_mapping(position_unit: str = "rad") -> dict[str, object]:
    """Declare what the columns of such a table are."""
    return {
        "time": {"column": "t", "unit": "s"},
        "position": {"columns": NAMES[1:4], "unit": position_unit},
        "torque": {"columns": NAMES[4:], "unit": "N m"},
    }
