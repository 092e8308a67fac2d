"""Meet the science: the one place where documents become core's types and core's types become documents.

`core.study` is imported where it is used, because it brings the solver and the compiled kernels with it: the
service answers before they are loaded, and a command that prints the contract never loads them.
"""

import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from ...core.errors import OptionError
from ...core.log.channels import CHANNELS
from ...core.log.preview import FEWEST_POINTS, preview
from ...core.log.reader import read_log
from ...core.robot.builtin import builtin_description, builtin_robots
from ...core.robot.description import robot_from_description
from ...core.robot.model import RobotModel
from ...core.robot.plausibility import suspicions
from ...core.robot.urdf import robot_from_urdf
from ...core.robot.writing import to_description
from ..json_text import plain
from ..store.blobs import check_file
from ..store.records import Document
from .computation import Computation, Glance, LogFile, Progress

if TYPE_CHECKING:
    from ...core.dynamics.model import DynamicModel
    from ...core.identification.options import IdentifyOptions

KINDS = ("identify", "diagnose")
MOST_NUMBERS = 600_000
"""Numbers of all traces of a log together."""


def built_in_descriptions() -> dict[str, Document]:
    """Give the descriptions of the built-in robots by name."""
    return {name: builtin_description(name) for name in builtin_robots()}


def read_description(description: object) -> tuple[RobotModel, Document]:
    """Read a robot description, and write it again with every default filled in.

    Raises
    ------
    RobotError
        If the description cannot be used.
    """
    robot = robot_from_description(cast("Document", description))  # core refuses what is no object
    return robot, to_description(robot)


def read_urdf(
    text: bytes, *, base_link: str | None, tip_link: str | None, gravity: tuple[float, ...] | None
) -> tuple[RobotModel, Document]:
    """Read a URDF, and write it as a description.

    Raises
    ------
    RobotError
        If the URDF cannot be used.
    """
    if gravity is None:
        robot = robot_from_urdf(text, base_link=base_link, tip_link=tip_link)
    else:
        robot = robot_from_urdf(text, base_link=base_link, tip_link=tip_link, gravity=gravity)
    return robot, to_description(robot)


def doubts(robot: RobotModel) -> tuple[str, ...]:
    """List what looks like a mistake in a description, although it can be used."""
    return suspicions(robot)


def summarise_log(log: LogFile, *, media_type: str | None) -> Document:
    """Read a log once and say what is in it.

    Raises
    ------
    LogError
        If the log cannot be used.
    """
    seen = read_log(log.path, media_type=media_type, mapping=log.mapping, name=log.name, sha256=log.sha256)
    summary = {
        "name": seen.name,
        "sha256": log.sha256,
        "mapping": log.mapping,
        "samples": seen.samples,
        "duration_s": seen.duration,
        "rate_hz": seen.rate_hz,
        "joints": seen.joints,
        "channels": seen.channels,
        "ignored_columns": seen.ignored_columns,
        "defects": [asdict(defect) for defect in seen.defects],
    }
    return {name: plain(value) for name, value in summary.items()}


def trace_log(log: LogFile, glance: Glance) -> Document:
    """Draw channels of a log with few points each, in single precision, as a screen needs them.

    Where there are very many traces, they have fewer points than are asked for.

    Raises
    ------
    OptionError
        If nothing was measured in the stretch of time that is asked for.
    Damaged
        If the log is not what it was.
    """
    check_file(log.path, log.sha256)
    seen = read_log(log.path, mapping=log.mapping, name=log.name, sha256=log.sha256)
    named = [(channel, joint) for channel in glance.channels for joint in range(1, seen.joints + 1)]
    few = max(FEWEST_POINTS, min(glance.points, MOST_NUMBERS // (len(named) + 1)))
    drawn = preview(seen, glance.channels, points=few, begin=glance.begin, end=glance.end)
    return {
        "name": seen.name,
        "samples": seen.samples,
        "rows_per_stretch": drawn.rows_per_stretch,
        "time": {"unit": "s", "values": [round(stamp, 6) for stamp in drawn.time.tolist()]},
        "traces": [
            {"channel": channel, "joint": joint, "unit": CHANNELS[channel].unit, "values": _short(values)}
            for (channel, joint), values in zip(named, drawn.values.T, strict=True)
        ],
    }


def read_options(kind: str, options: Document) -> "IdentifyOptions":
    """Read the options of a kind of job.

    Raises
    ------
    OptionError
        If there is no such kind of job, or an option does not exist or makes no sense.
    """
    if kind not in KINDS:
        raise OptionError(
            f"there is no job of kind {kind}",
            evidence={"given": kind, "known": list(KINDS)},
            remedy="ask for one of the known kinds",
        )
    from ...core.identification.options import parse_diagnose_options, parse_options

    return (parse_diagnose_options if kind == "diagnose" else parse_options)(options)


def model_of(description: Document, terms: tuple[str, ...] | None) -> "DynamicModel":
    """Give the model of a robot with the chosen torque terms.

    Raises
    ------
    OptionError
        If the terms do not fit the robot.
    """
    from ...core.dynamics.model import standard_model

    return standard_model(robot_from_description(description), terms)


def admit(options: "IdentifyOptions", model: "DynamicModel", logs: Sequence[Document]) -> None:
    """Refuse options that a robot's model or logs do not allow, from what the logs' summaries say.

    Raises
    ------
    OptionError
        If an option does not fit them.
    LogError
        If a log is given twice, or holds currents and the robot does not say what torque a current gives.
    """
    from ...core.identification.admission import KnownLog, admit

    known = [
        KnownLog(
            str(log["name"]),
            tuple(cast("list[str]", log["channels"])),
            cast("float", log["rate_hz"]),
            cast("float", log["duration_s"]),
            cast("int", log["samples"]),
            1 + sum(one["count"] for one in _defects(log) if one["kind"] == "gap"),
            str(log["sha256"]),
        )
        for log in logs
    ]
    admit(options, model, known)


def reference_job(kind: str, options: Document) -> str | None:
    """Name the job that a request compares its logs with; None where it compares with none.

    Raises
    ------
    OptionError
        If an option does not exist or makes no sense.
    """
    name = _reference_name(options) if kind == "diagnose" else None
    if name is None:
        return None
    from ...core.identification.reference import PRIOR

    return None if name == PRIOR else name


def check_reference(description: Document, options: Document, reference: Path | None) -> None:
    """Refuse a reference that a robot's logs cannot be compared with.

    Raises
    ------
    OptionError
        If it is the result of another robot's log, or options are given that it decides.
    RobotError
        If the robot's own bodies are to be compared with and it brings none.
    """
    if _reference_name(options) is None:  # no request waits for the solver to be loaded but one that needs it
        return
    from ...core import study

    robot = robot_from_description(description)
    study.check_reference(study.IdentifyRequest(robot, (), options, _result(reference)))


def base_parameters(description: Document) -> Document:
    """Say which combinations of parameters any motion of a robot can tell apart.

    Raises
    ------
    RobotError
        If the description cannot be used.
    """
    from ...core import study

    document: Document = study.base_parameters(robot_from_description(description))
    return document


def compute(computation: Computation, progress: Progress) -> Document:
    """Identify a robot or diagnose its simulation; the work of a job.

    Raises
    ------
    VeritorqueError
        If the robot, the logs or the options do not allow it.
    Damaged
        If a log or the result to compare with is not what it was.
    """
    from ...core import study

    for log in computation.logs:
        check_file(log.path, log.sha256)
    robot = robot_from_description(computation.robot)
    logs = tuple(
        read_log(log.path, mapping=log.mapping, name=log.name, sha256=log.sha256) for log in computation.logs
    )
    request = study.IdentifyRequest(
        robot, logs, computation.options, _result(computation.reference), computation.traces
    )
    document: Document = (study.diagnose if computation.kind == "diagnose" else study.identify)(
        request, progress
    )
    return document


def _defects(log: Document) -> list[dict[str, Any]]:
    return cast("list[dict[str, Any]]", log["defects"])


def _short(values: np.ndarray) -> list[float | None]:
    """Write numbers with the digits that single precision has; None for NaN."""
    return [None if np.isnan(value) else float(str(value)) for value in values.astype(np.float32)]


def _reference_name(options: Document) -> str | None:
    return read_options("diagnose", options).reference


def _result(reference: Path | None) -> Document | None:
    """Read the result of an earlier job."""
    if reference is None:
        return None
    check_file(reference, reference.name)
    return cast("Document", json.loads(reference.read_bytes()))
