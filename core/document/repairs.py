"""Write repairs into a result document, and read them back to do them again on another log or robot."""

from collections.abc import Iterable, Mapping
from typing import Any

from ..extension.repair import Repair, repaired_robot
from ..robot.model import RobotModel
from ..robot.writing import to_description


def repaired_description(robot: RobotModel, repairs: Iterable[Repair]) -> dict[str, object] | None:
    """Describe the robot with all its repairs; None where nothing in the description changes."""
    repaired = repaired_robot(robot, repairs)
    return None if repaired is robot else to_description(repaired)


def read_repairs(document: Mapping[str, Any]) -> tuple[Repair, ...]:
    """Read the repairs that the result document of a diagnosis lists; none where it is of another kind."""
    listed = (document.get("diagnosis") or {}).get("repairs", ())
    return tuple(
        Repair(entry["cause"], tuple(entry["joints"]), entry["mends"], entry["what"], entry["numbers"])
        for entry in listed
    )
