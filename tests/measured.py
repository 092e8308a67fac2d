"""Load measured robots and their logs, public and kept beside the project; without them tests skip loudly."""

import json
import re
from functools import cache
from typing import Any

import numpy as np
import pyarrow.parquet as pq

from tests.tools import shared
from veritorque.core.log.model import JointLog
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.model import RobotModel
from veritorque.core.robot.urdf.read import robot_from_urdf
from veritorque.core.study import IdentifyRequest, identify

FRANKA_ROWS = 20_544
TX40_TRAIN = (500, round((0.1 + 0.7 * 7.3) * 5000))
TX40_TEST = (TX40_TRAIN[1], 37_000)


@cache
def measured_log(robot: str, run: str, start: int = 0, stop: int | None = None) -> JointLog:
    """Cut rows out of a run, with position in rad and joint torque in N m."""
    table = pq.read_table(shared(f"data/{robot}/runs/{run}.parquet"))
    joints = sum(re.fullmatch(r"q_\d+", name) is not None for name in table.column_names)

    def columns(prefix: str) -> np.ndarray:
        return np.column_stack([table[f"{prefix}_{joint}"].to_numpy() for joint in range(1, joints + 1)])

    cut = slice(start, stop)
    return log_from_arrays(run, table["time"].to_numpy()[cut], columns("q")[cut], columns("tau")[cut])


@cache
def measured_robot(name: str, *, coupled: bool = True) -> RobotModel:
    """Describe a robot; the TX40 without its coupled wrist if so asked, as one who does not know of it."""
    if name == "ur10e_open":
        return robot_from_urdf(shared(f"data/{name}/robot.urdf").read_bytes())
    table = json.loads(shared(f"data/{name}/model_mdh.json").read_text())
    joints = [
        {
            "type": "prismatic" if row["sigma"] else "revolute",
            "alpha": row["alpha"],
            "d": row["d"],
            "r": row["r"],
            "theta_offset": row["theta"],
        }
        for row in table["mdh"]
    ]
    couplings = []
    if name == "staubli_tx40" and coupled:
        # Motor 6 turns with q5 + q6, so the inertia that joint 6 would have alone is the coupling's.
        joints[5]["rotor_inertia"] = False
        couplings = [{"name": "wrist", "joints": [5, 6], "weights": [1.0, 1.0], "number": 6}]
    return robot_from_description(
        {"name": name, "joints": joints, "gravity": table["gravity"], "couplings": couplings}
    )


def identified(name: str, *logs: JointLog, held_out: int | None = None, **options: object) -> dict[str, Any]:
    """Identify a measured robot, once for all who ask the same; the fit does not see the log `held_out`."""
    validation = {} if held_out is None else {"validation": {"logs": [held_out]}}
    return _identified(name, logs, json.dumps({"bootstrap": {"draws": 0}} | validation | options))


@cache
def _identified(name: str, logs: tuple[JointLog, ...], options: str) -> dict[str, Any]:
    return dict(identify(IdentifyRequest(measured_robot(name), logs, json.loads(options))))
