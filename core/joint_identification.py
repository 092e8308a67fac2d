"""Identify the continuous-time model of one joint that moves alone, and give the document."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from .document.joint_model import joint_document
from .document.version import product_version
from .identification.identify import Progress, no_progress
from .joint_model.identify import identify_joint
from .joint_model.options import check_one_log, parse_joint_options
from .log.model import JointLog
from .numerics.threads import on_one_thread
from .robot.model import RobotModel


@dataclass(frozen=True, eq=False)
class JointRequest:
    """Ask for the model of a joint, with options as plain data."""

    robot: RobotModel
    logs: tuple[JointLog, ...]
    options: Mapping[str, object] = field(default_factory=dict)


@on_one_thread()
def model_joint(request: JointRequest, progress: Progress | None = None) -> dict[str, object]:
    """Identify the model of a joint and give the document.

    Raises
    ------
    VeritorqueError
        Whatever stands in the way, with cause, evidence and remedy.
    """
    options = parse_joint_options(request.options)
    check_one_log(len(request.logs))
    found = identify_joint(request.robot, request.logs[0], options, progress or no_progress)
    return joint_document(found, version=product_version(), options=dict(request.options))
