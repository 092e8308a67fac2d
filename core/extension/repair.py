"""Turn findings into repairs that a user can take: of the robot's description, of the log, or neither.

A repair is plain numbers beside a sentence, so that it can be written in a document and done again from
there. It is of first order where its finding is: after a large one a second diagnosis finds the remainder.
"""

from collections.abc import Iterable
from dataclasses import dataclass

from ..diagnosis.causes.protocol import FittedCause, Numbers, Site
from ..diagnosis.causes.registry import BY_ID
from ..diagnosis.causes.repairs import Corrects, CorrectsRobot, corrects
from ..diagnosis.causes.sample_check import SampleCheck
from ..diagnosis.result import Diagnosis, Finding
from ..diagnosis.search.hypothesis import Candidate
from ..robot.model import RobotModel
from .cure import enters

NOT_IN_LOG = "Nothing is changed for it: the log does not hold what would replace it"
NOT_SURE = "Nothing is changed for it: its gain on held-out rows is not significant"


@dataclass(frozen=True)
class Repair:
    """State what is changed because of one finding."""

    cause: str
    joints: Site
    """The finding's cause and joints."""
    mends: Corrects
    """What is changed: the description (`robot`), the `log`, the `model` (a further term), or `nothing`."""
    what: str
    """What goes from what to what, in one sentence."""
    numbers: Numbers
    """What the repair is done with, by name, in SI."""


def repairs(diagnosis: Diagnosis) -> tuple[Repair, ...]:
    """Give the repair of every finding, in their order."""
    robot = diagnosis.dataset.robot
    found: list[Repair] = []
    for finding in diagnosis.findings:
        found.append(_repair(finding, diagnosis, robot))
        robot = repaired_robot(robot, found[-1:])
    return tuple(found)


def repaired_robot(robot: RobotModel, repairs: Iterable[Repair]) -> RobotModel:
    """Correct a robot's description by all repairs that are of it."""
    for repair in repairs:
        cause: object = BY_ID.get(repair.cause)
        if repair.mends == "robot" and isinstance(cause, CorrectsRobot):
            robot = cause.corrected_robot(robot, repair.joints, repair.numbers)
    return robot


def _repair(finding: Finding, diagnosis: Diagnosis, robot: RobotModel) -> Repair:
    if finding.member is None:
        known = BY_ID[finding.cause]
        why = known.beyond_repair if isinstance(known, SampleCheck) else NOT_IN_LOG
        return Repair(finding.cause, finding.joints, "nothing", why, {})
    if not enters(finding):
        return Repair(finding.cause, finding.joints, "nothing", NOT_SURE, {})
    cause = finding.member.cause
    numbers = cause.numbers(diagnosis.dataset, _fitted_cause(diagnosis, finding.member))
    what = cause.repair(robot, finding.joints, numbers)
    return Repair(finding.cause, finding.joints, corrects(cause), what, numbers)


def _fitted_cause(diagnosis: Diagnosis, member: Candidate) -> FittedCause:
    chosen = diagnosis.chosen
    return chosen.solved(chosen.members.index(member))
