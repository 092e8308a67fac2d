"""Write a described robot, whose bodies were not identified, as a URDF."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..document.model.identified import IdentifiedRobot
from ..dynamics.model import standard_model
from ..errors import RobotError
from ..robot.description import robot_from_description
from .urdf import write_urdf
from .urdf_in_place import urdf_with_inertials

CORRECTED = "The bodies are those of the description, its contradicted entries corrected by an audit."


def urdf_of_description(description: Mapping[str, Any]) -> bytes:
    """Write the bodies of a description as a URDF.

    Raises
    ------
    RobotError
        If it has none.
    OptionError
        If one of them is physically inconsistent.
    """
    return write_urdf(_described(description)).encode()


def urdf_with_bodies(
    text: bytes, description: Mapping[str, Any], *, base_link: str | None = None, tip_link: str | None = None
) -> bytes:
    """Put the bodies of a description into the URDF that the robot was made from.

    Raises
    ------
    RobotError
        If it has none, or the URDF describes another robot.
    OptionError
        If one of them is physically inconsistent.
    """
    return urdf_with_inertials(text, _described(description), base_link=base_link, tip_link=tip_link)


def _described(description: Mapping[str, Any]) -> IdentifiedRobot:
    robot = robot_from_description(description)
    if robot.prior is None:
        raise RobotError(
            "the description has no bodies",
            evidence={"robot": robot.name, "prior": None},
            remedy="give masses, mass centres and inertias of its links",
        )
    model = standard_model(robot, ("rigid_body",))
    standard = np.asarray(robot.prior).ravel()
    return IdentifiedRobot(model, standard, ("no",) * len(standard), remarks=(CORRECTED,))
