"""Read a result document back as the reference that a later log is compared with.

The document of an identification says what was found and, by `precision.information_factor`, how well all of
it is known together. What a diagnosis says of the robot before its correction is the same, so that either
kind of result may be a reference.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from ...arrays import Matrix
from ...errors import OptionError
from ...identification.reference import Reference, with_least_deviation
from ...reduction.base import base_model
from ...robot.description import robot_from_description
from ...robot.differences import differences
from ...robot.model import RobotModel
from .answer import plain_document
from .reading import FLEXIBLE, model_of_result

Document = Mapping[str, Any]


def reference_from_document(document: Document, robot: RobotModel, name: str) -> Reference:
    """Take the result of an earlier job for the reference.

    Parameters
    ----------
    robot
        The robot of the new log: it has to be the same as the result's.
    name
        What the job is called.

    Raises
    ------
    OptionError
        If the result is another robot's, or does not say how well its parameters are known together.
    """
    _check_robot(document, robot, name)
    if "base_parameters" not in document:
        raise OptionError(
            f"the result of {name} holds no identified parameters",
            evidence={"reference": name, "kind": document.get("kind")},
            remedy="name a job that identifies or diagnoses the robot",
        )
    document = plain_document(document)
    _check_rigid(document, name)
    model = model_of_result(document, robot)
    base = base_model(model)
    rows = {row["name"]: row for row in document["base_parameters"]}
    standard = {row["name"]: row["value"] for row in document["standard_parameters"]}
    factor = document["precision"].get("information_factor")
    if factor is None:
        raise OptionError(
            f"the result of {name} does not say how well its parameters are known together",
            evidence={"reference": name, "missing": "/precision/information_factor"},
            remedy="identify the robot from the earlier log again, and name that job",
        )
    if list(rows) != list(base.names):
        raise OptionError(
            f"the result of {name} has other base parameters than the robot of this log",
            evidence={"reference": name, "differ": sorted(set(rows) ^ set(base.names))[:10]},
            remedy="identify the robot from the earlier log again, and name that job",
        )
    values = np.array([row["value"] for row in rows.values()], dtype=float)
    known = np.array([standard[parameter.name] for parameter in model.parameters], dtype=float)
    return Reference(
        name, base, known, values, with_least_deviation(read_factor(factor, len(values)), values)
    )


def write_factor(rows: Matrix) -> list[list[float]]:
    """Write a triangular factor without the zeros below its diagonal.

    Examples
    --------
    >>> write_factor(np.array([[2.0, 1.0], [0.0, 3.0]]))
    [[2.0, 1.0], [3.0]]
    """
    return [[float(entry) for entry in row[index:]] for index, row in enumerate(rows)]


def read_factor(written: list[list[float]], size: int) -> Matrix:
    """Read it back.

    Examples
    --------
    >>> read_factor([[2.0, 1.0], [3.0]], 2)
    array([[2., 1.],
           [0., 3.]])
    """
    rows = np.zeros((len(written), size))
    for index, row in enumerate(written):
        rows[index, index:] = row
    return rows


def _check_robot(document: Document, robot: RobotModel, name: str) -> None:
    differing = differences(robot_from_description(document["robot"]), robot)
    if differing:
        raise OptionError(
            f"the reference {name} is another robot than the one of this log",
            evidence={"reference": name, "differ": list(differing)},
            remedy="name a job of the same robot, with the same table, gravity and declared friction",
        )


def _check_rigid(document: Document, name: str) -> None:
    if FLEXIBLE in document.get("terms", ()):
        raise OptionError(
            f"the result of {name} has flexible joints, with which no later log is compared",
            evidence={"reference": name, "terms": document["terms"]},
            remedy="identify the robot from the earlier log without flexible_joints, and name that job",
        )
