"""Do the like of what most jobs do, for processes that wait for one: identify a robot from a made-up log.

A process has to get every page of its memory from the system once, and libraries put off what they can until
they are asked for the first time. Both together take a tenth of a second.
"""

import numpy as np
import pyarrow as pa
from pyarrow.csv import write_csv

from ...core.log.reader import read_log
from ...core.robot.builtin import builtin_description
from ...core.robot.description import robot_from_description
from ..store.blobs import BlobStore
from .computation import Progress

SAMPLES = 7500
RATE_HZ = 250.0


def rehearse(blobs: BlobStore, progress: Progress) -> None:
    """Read the log from a file, identify the robot and write the traces; whatever comes out is forgotten.

    Files stand among the blobs that are received, where those of a process that was killed are removed.
    """
    from ...core import study

    robot = robot_from_description(builtin_description("yumi-left"))
    with blobs.aside() as traces:
        file = traces.with_name("log.csv")
        write_csv(_made_up(len(robot.joints)), file)
        request = study.IdentifyRequest(robot, (read_log(file),), {"bootstrap": {"draws": 0}}, traces=traces)
        study.identify(request, progress)


def _made_up(joints: int) -> pa.Table:
    """Write what joints might measure that swing, each at a pace of its own."""
    time = np.arange(SAMPLES) / RATE_HZ
    columns = {"time": time}
    for joint in range(1, joints + 1):
        columns[f"q_{joint}"] = 0.5 * np.sin((0.5 + 0.3 * joint) * time)
        columns[f"tau_{joint}"] = np.cos((0.5 + 0.3 * joint) * time) + np.sin(7.0 * joint * time)
    return pa.table(columns)
