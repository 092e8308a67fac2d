"""Compute base parameters, which need no log and no job."""

from ...core.robot.description import robot_from_description
from ..store.records import Document


def base_parameters(description: Document) -> Document:
    """Say which combinations of parameters any motion of a robot can distinguish.

    Raises
    ------
    RobotError
        If the description cannot be used.
    """
    from ...core.document import base_parameters as written

    document: Document = written.base_parameters(robot_from_description(description))
    return document
