"""Carry out a computation: check and read its files, and let its kind compute the result document."""

import json
from typing import cast

from ...core.log.reader import read_log
from ...core.robot.description import robot_from_description
from ...core.robot.joint_units import prismatic_numbers
from ..kinds.kind import Inputs, Progress
from ..kinds.registry import kind_of
from ..store.blobs.blob_store import check_file
from ..store.records import Document
from .computation import Computation, Workspace


def compute(computation: Computation, workspace: Workspace, progress: Progress) -> Document:
    """Compute a result document; the work of a job.

    Raises
    ------
    VeritorqueError
        If the robot, the logs or the options do not allow it.
    DamagedError
        If a log or the earlier result is missing, or does not have its digest.
    """
    kind, files = kind_of(computation.kind), workspace.files
    for log in computation.logs:
        check_file(files[log.sha256], log.sha256)
    robot = robot_from_description(computation.robot)
    prismatic = prismatic_numbers(robot)
    inputs = Inputs(
        robot=robot,
        logs=tuple(
            read_log(
                files[log.sha256], mapping=log.mapping, name=log.name, sha256=log.sha256, prismatic=prismatic
            )
            for log in computation.logs
        ),
        options=computation.options,
        reference=_earlier_result(computation, workspace),
        traces=workspace.traces,
    )
    return kind.compute(inputs, progress)


def _earlier_result(computation: Computation, workspace: Workspace) -> Document | None:
    if computation.reference is None:
        return None
    file = workspace.files[computation.reference]
    check_file(file, computation.reference)
    return cast("Document", json.loads(file.read_bytes()))
