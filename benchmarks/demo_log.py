"""Read the log of the simulated YuMi arm that the demonstration ships, and simulate its motion again.

The truth that the log was made from stands beside it.
"""

import json
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np

from examples.yumi import arm, make_log
from examples.yumi.excitation import Excitation
from veritorque.core.log.model import JointLog
from veritorque.core.log.reader import log_from_arrays, read_log
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.model import RobotModel

FOLDER: Final = Path(arm.HERE)


def demo_robot() -> RobotModel:
    """Give the robot as the service is told about it."""
    return robot_from_description(arm.robot_description())


def demo_log() -> JointLog:
    """Read the shipped log."""
    return read_log(FOLDER / "log.csv")


@cache
def truth() -> dict[str, float]:
    """Give the true standard parameters by name."""
    document = json.loads((FOLDER / "truth.json").read_text(encoding="utf-8"))
    return dict(document["standard_parameters"])


@cache
def motion(until: float) -> make_log.SimulatedMotion:
    """Simulate the shipped log's motion without noise, up to a time in s."""
    described = json.loads((FOLDER / "truth.json").read_text(encoding="utf-8"))["motion"]
    excitation = Excitation(*(np.array(described[name]) for name in ("centre", "sine", "cosine")))
    return make_log.simulate(excitation=excitation, until=until)


def noisy_log(until: float, noise_seed: int) -> JointLog:
    """Measure the motion once more with other noise."""
    columns = make_log.measure(motion(until), noise_seed)
    position, torque = (
        np.column_stack([columns[f"{kind}_{joint}"] for joint in range(1, arm.JOINTS + 1)])
        for kind in ("q", "tau")
    )
    return log_from_arrays(f"noise {noise_seed}", columns["time"], position, torque)
