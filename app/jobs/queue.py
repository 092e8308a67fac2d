"""Accept jobs and let go of them; what cannot succeed is refused at once, in the words of the science."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

from ...core.errors import LogError
from ..problems import Problem
from ..services.catalogue import Catalogue
from ..store.queueing import Asked, Outcome
from ..store.records import UNFINISHED, Document, JobRecord, JobRequestRecord, LogRecord, RobotRecord
from ..store.store import TenantStore
from . import computations as science
from .references import check_reference

if TYPE_CHECKING:
    from ...core.dynamics.model import DynamicModel


@dataclass(frozen=True)
class Wanted:
    """Ask for a job of a robot and logs by their ids.

    Attributes
    ----------
    key
        What the client calls its request, so that it can send it twice and mean it once.
    trace
        Id of the trace that the request belongs to.
    """

    kind: str
    robot: str
    logs: tuple[str, ...]
    options: Document
    key: str | None = None
    trace: str | None = None


class Queue:
    """Accept and dismiss the jobs of a tenant."""

    def __init__(self, store: TenantStore, catalogue: Catalogue) -> None:
        self._store, self._catalogue = store, catalogue

    def begin_to_submit(self, wanted: list[Wanted]) -> Callable[[], list[Outcome]]:
        """Queue jobs together, or find those that asked for the same; give what waits until they are kept.

        For each that gives the job, or why it cannot be: an error of the science, a `Problem` where something
        that is named does not exist, or what the store refuses.
        """
        robot = cache(lambda identity: self._catalogue.robot(identity, named_in_body=True))
        log = cache(lambda identity: self._catalogue.log(identity, named_in_body=True))
        model = cache(lambda identity, terms: science.model_of(robot(identity).description, terms))
        checked = [self._checked(one, robot, log, model) for one in wanted]
        wait = self._store.jobs.begin_to_add([one for one in checked if isinstance(one, Asked)])

        def outcomes() -> list[Outcome]:
            queued = iter(wait())
            return [one if isinstance(one, Exception) else next(queued) for one in checked]

        return outcomes

    def _checked(
        self,
        wanted: Wanted,
        robot_of: Callable[[str], RobotRecord],
        log_of: Callable[[str], LogRecord],
        model_of: Callable[[str, tuple[str, ...] | None], "DynamicModel"],
    ) -> Asked | Exception:
        """Refuse at once what cannot succeed."""
        try:
            robot, logs = robot_of(wanted.robot), tuple(log_of(identity) for identity in wanted.logs)
            options = science.read_options(wanted.kind, wanted.options)
            for log in logs:
                _check_joints(robot, log)
            science.admit(options, model_of(wanted.robot, options.terms), [log.summary for log in logs])
            check_reference(self._store, wanted.kind, robot, wanted.options)
        except Exception as error:  # noqa: BLE001 - it belongs to the one who asked
            return error
        ids = tuple(log.id for log in logs)
        return Asked(JobRequestRecord(wanted.kind, robot.id, ids, wanted.options), wanted.key, wanted.trace)

    def dismiss(self, job: JobRecord) -> JobRecord:
        """Dismiss an unfinished job; whoever computes it notices."""
        return self._store.jobs.dismiss(job.id) or job

    def refuse_if_needed(self, *, robot: str | None = None, log: str | None = None) -> None:
        """Refuse to delete what an unfinished job needs.

        Raises
        ------
        Problem
            If an unfinished job names the robot or the log (409).
        """
        waiting = self._store.jobs.unfinished_requests()
        users = [request for request in waiting if request.robot == robot or log in request.logs]
        if users:
            raise Problem(
                "in-use",
                f"{robot or log} is needed by jobs that are not finished",
                evidence={"jobs": len(users), "states": list(UNFINISHED)},
                remedy="wait for these jobs or dismiss them",
            )


def _check_joints(robot: RobotRecord, log: LogRecord) -> None:
    if log.joints == robot.joints:
        return
    name = log.summary["name"]
    raise LogError(
        f"the log {name} has {_joints(log.joints)}, the robot {robot.name} has {robot.joints}",
        evidence={"log": log.id, "log_joints": log.joints, "robot": robot.id, "robot_joints": robot.joints},
        remedy="choose the robot that was measured, or map exactly one column per joint",
    )


def _joints(count: int) -> str:
    return f"{count} joint" if count == 1 else f"{count} joints"
