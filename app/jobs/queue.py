"""Accept jobs and let go of them; what cannot succeed is refused at once, in the words of the science."""

from concurrent.futures import Future

from app.jobs import science
from app.jobs.references import check_reference
from app.problems import Problem
from app.store.records import UNFINISHED, Document, JobRecord, JobRequestRecord, LogRecord, RobotRecord
from app.store.store import TenantStore
from core.errors import LogError


class Queue:
    """Accept and dismiss the jobs of a tenant; new ones belong to a trace."""

    def __init__(self, store: TenantStore, trace: str | None = None) -> None:
        self._store, self._trace = store, trace

    def submit(
        self,
        *,
        kind: str,
        robot: RobotRecord,
        logs: tuple[LogRecord, ...],
        options: Document,
        key: str | None = None,
    ) -> "Future[JobRecord]":
        """Queue a job, or find the one that asks for the same; give it once that is on the disk.

        `key` is what the client calls its request, so that it can send it twice and mean it once.

        Raises
        ------
        OptionError
            If the kind or an option does not exist or makes no sense.
        LogError
            If a log has not as many joints as the robot.
        RobotError
            If the robot's own bodies are to be compared with and it brings none.
        Problem
            If a job that is to be compared with does not exist (422).
        """
        science.check_options(kind, options)
        for log in logs:
            _check_joints(robot, log)
        check_reference(self._store, kind, robot, options)
        request = JobRequestRecord(kind, robot.id, tuple(log.id for log in logs), options)
        return self._store.jobs.begin_to_add(request, key=key, trace=self._trace)

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
