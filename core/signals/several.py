"""Condition all logs of a request, and refuse what would count the same data twice."""

from collections.abc import Sequence

from ..errors import LogError, VeritorqueError
from ..log.model import JointLog
from ..robot.model import RobotModel
from .condition import Motion, condition
from .recipe import FilterOptions


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
    for number, log in enumerate(logs):
        try:
            motions.append(condition(log, robot, options, blocks=blocks, number=number))
        except VeritorqueError as error:
            error.evidence.setdefault("log", log.name)
            raise
    return tuple(motions)


def check_different(names: Sequence[str], hashes: Sequence[str]) -> None:
    """Refuse the same log twice; logs whose hash is not known, which is then empty, pass.

    Raises
    ------
    LogError
        If two logs hold the same bytes.
    """
    known = [digest for digest in hashes if digest]
    if len(set(known)) < len(known):
        raise LogError(
            "the same log is given more than once, and would count as independent data",
            evidence={"logs": list(names), "different": len(set(known))},
            remedy="name every log once",
        )


def _check(logs: tuple[JointLog, ...]) -> None:
    if not logs:
        raise LogError("there is no log to identify from", evidence={"logs": 0}, remedy="name at least one")
    check_different([log.name for log in logs], [log.sha256 for log in logs])
