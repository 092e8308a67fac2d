"""Condition all logs of a request, and refuse what would count the same data twice."""

from core.errors import LogError, VeritorqueError
from core.log.model import JointLog
from core.robot.model import RobotModel
from core.signals.condition import Motion, condition
from core.signals.recipe import FilterOptions


def condition_all(
    logs: tuple[JointLog, ...], robot: RobotModel, options: FilterOptions, *, blocks: int
) -> tuple[Motion, ...]:
    """Condition every log.

    Parameters
    ----------
    blocks
        Number of blocks each log is divided into.

    Raises
    ------
    LogError
        If there is no log, one is given twice, or one cannot be used; the last names the log.
    """
    _check(logs)
    motions = []
    for log in logs:
        try:
            motions.append(condition(log, robot, options, blocks=blocks))
        except VeritorqueError as error:
            error.evidence.setdefault("log", log.name)
            raise
    return tuple(motions)


def _check(logs: tuple[JointLog, ...]) -> None:
    if not logs:
        raise LogError("there is no log to identify from", evidence={"logs": 0}, remedy="name at least one")
    hashes = [log.sha256 for log in logs if log.sha256]
    if len(set(hashes)) < len(hashes):
        raise LogError(
            "the same log is given more than once, and would count as independent data",
            evidence={"logs": [log.name for log in logs], "different": len(set(hashes))},
            remedy="name every log once",
        )
