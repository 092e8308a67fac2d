"""Accept and dismiss jobs; what cannot succeed is refused at once, by the kind of the job."""

import json
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial
from typing import TYPE_CHECKING

from ...core.errors import LogError
from ..kinds.kind import PlannedJob
from ..kinds.registry import kind_of
from ..problems import Problem
from ..services.catalogue import Catalogue
from ..services.robot_descriptions import model_of
from ..store.queueing import NewJob, Outcome
from ..store.records import UNFINISHED, Document, JobRecord, JobRequestRecord, LogRecord, RobotRecord
from ..store.store import TenantStore
from .inputs import result_digest

if TYPE_CHECKING:
    from ...core.dynamics.model import DynamicModel


@dataclass(frozen=True)
class Submission:
    """Ask for a job of a robot and logs by their ids."""

    kind: str
    robot: str
    logs: tuple[str, ...]
    options: Document
    key: str | None = None
    """The client's Idempotency-Key, which makes a repeated request the same job."""
    trace: str | None = None
    """Id of the trace that the request belongs to."""


class Queue:
    """Accept and dismiss the jobs of a tenant."""

    def __init__(self, store: TenantStore, catalogue: Catalogue) -> None:
        self._store, self._catalogue = store, catalogue

    def begin_to_submit(self, submissions: list[Submission]) -> Callable[[], list[Outcome]]:
        """Queue jobs together, or find those that asked for the same; give what waits until they are kept.

        For each that gives the job, or why it is refused: an error of core, a `Problem` where something
        that is named does not exist, or what the store refuses.
        """
        robot = cache(lambda identity: self._catalogue.robot(identity, named_in_body=True))
        log = cache(lambda identity: self._catalogue.log(identity, named_in_body=True))
        model = cache(lambda identity, terms: model_of(robot(identity).description, terms))
        checked = [self._check(submission, robot, log, model) for submission in submissions]
        wait = self._store.jobs.begin_to_add([new for new in checked if isinstance(new, NewJob)])

        def outcomes() -> list[Outcome]:
            queued = iter(wait())
            return [new if isinstance(new, Exception) else next(queued) for new in checked]

        return outcomes

    def _check(
        self,
        submission: Submission,
        robot_of: Callable[[str], RobotRecord],
        log_of: Callable[[str], LogRecord],
        model_by_id: Callable[[str, tuple[str, ...] | None], "DynamicModel"],
    ) -> NewJob | Exception:
        """Refuse at once what cannot succeed."""
        try:
            robot = robot_of(submission.robot)
            logs = tuple(log_of(identity) for identity in submission.logs)
            kind = kind_of(submission.kind)
            kind.require_logs(len(logs))
            options = kind.read_options(submission.options)
            for log in logs:
                _check_joints(robot, log)
            planned = PlannedJob(
                robot=robot.description,
                logs=tuple(log.summary for log in logs),
                options=submission.options,
                model=partial(model_by_id, submission.robot),
                earlier_result=self._result,
            )
            kind.admit(planned, options)
        except Exception as error:  # noqa: BLE001 - it is the caller's answer
            return error
        ids = tuple(log.id for log in logs)
        request = JobRequestRecord(kind.name, robot.id, ids, submission.options)
        return NewJob(request, submission.key, submission.trace)

    def _result(self, job: str) -> Document:
        document: Document = json.loads(self._store.blobs.read(result_digest(self._store, job)))
        return document

    def dismiss(self, job: JobRecord) -> JobRecord:
        """Dismiss an unfinished job; its worker stops the computation."""
        return self._store.jobs.dismiss(job.id) or job

    def refuse_if_needed(self, *, robot: str = "", log: str = "", reference: str = "") -> None:
        """Refuse to delete what an unfinished job needs; a reference is the job that it compares with.

        Raises
        ------
        Problem
            If an unfinished job names it (409).
        """
        waiting = self._store.jobs.unfinished_requests()
        users = [
            request
            for request in waiting
            if request.robot == robot or log in request.logs or reference == _reference(request)
        ]
        if users:
            raise Problem(
                "in-use",
                f"{robot or log or reference} is needed by jobs that are not finished",
                evidence={"jobs": len(users), "states": list(UNFINISHED)},
                remedy="wait for these jobs or dismiss them",
            )


def _reference(request: JobRequestRecord) -> str | None:
    return kind_of(request.kind).reference(request.options)


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
