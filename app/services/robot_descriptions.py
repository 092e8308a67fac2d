"""Read robot descriptions and URDFs: text goes in, robot models and complete descriptions come out."""

from typing import TYPE_CHECKING, cast

from ...core.robot.builtin import builtin_description, builtin_robots
from ...core.robot.description import robot_from_description
from ...core.robot.model import RobotModel
from ...core.robot.plausibility import plausibility_warnings
from ...core.robot.urdf.read import robot_from_urdf
from ...core.robot.writing import to_description
from ..store.records import Document, RobotRecord

if TYPE_CHECKING:
    from ...core.dynamics.model import DynamicModel


def built_in_descriptions() -> dict[str, Document]:
    """Give the descriptions of the built-in robots by name."""
    return {name: builtin_description(name) for name in builtin_robots()}


def built_in_robots() -> dict[str, RobotRecord]:
    """Give the robots that everybody has, by id."""
    return {name: _built_in(name, description) for name, description in built_in_descriptions().items()}


def _built_in(name: str, description: Document) -> RobotRecord:
    robot, written = read_description(description)
    return RobotRecord(
        id=name,
        name=robot.name,
        joints=len(robot.joints),
        built_in=True,
        description=written,
        suspicions=plausibility_warnings(robot),
        created_at=None,
    )


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


def model_of(description: Document, terms: tuple[str, ...] | None) -> "DynamicModel":
    """Give the model of a robot with the chosen torque terms.

    Raises
    ------
    OptionError
        If the terms do not fit the robot.
    """
    from ...core.dynamics.model import standard_model

    return standard_model(robot_from_description(description), terms)
