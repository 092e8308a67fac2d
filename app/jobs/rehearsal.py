"""Rehearse the most frequent job in processes that wait for one: identify a robot from a synthetic log.

A process gets its memory from the system page by page, and libraries defer work until they are first used.
Together that takes a tenth of a second, which the first real computation would otherwise wait for.
"""

import numpy as np
import pyarrow as pa
from pyarrow.csv import write_csv

from ...core.log.reader import read_log
from ...core.robot.builtin import builtin_description
from ...core.robot.description import robot_from_description
from ..kinds.identify import Identify
from ..kinds.kind import Inputs, Progress
from ..store.blobs.blob_store import BlobStore

SAMPLES = 7500
RATE_HZ = 250.0


def rehearse(blobs: BlobStore, progress: Progress) -> None:
    """Read the log from a file, identify the robot, write the traces, and discard all of it.

    The files are scratch files of the blob store, which removes those of processes that were killed.
    """
    robot = robot_from_description(builtin_description("yumi-left"))
    with blobs.scratch_file() as traces:
        file = traces.with_name("log.csv")
        write_csv(_synthetic_log(len(robot.joints)), file)
        options: dict[str, object] = {"bootstrap": {"draws": 0}}
        Identify().compute(Inputs(robot, (read_log(file),), options, traces=traces), progress)


def _synthetic_log(joints: int) -> pa.Table:
    """Write what joints might measure that oscillate, each at its own frequency."""
    time = np.arange(SAMPLES) / RATE_HZ
    columns = {"time": time}
    for joint in range(1, joints + 1):
        columns[f"q_{joint}"] = 0.5 * np.sin((0.5 + 0.3 * joint) * time)
        columns[f"tau_{joint}"] = np.cos((0.5 + 0.3 * joint) * time) + np.sin(7.0 * joint * time)
    return pa.table(columns)
