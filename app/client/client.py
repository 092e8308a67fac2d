"""Use a service as a lab does: upload logs, describe robots, identify, diagnose, take results home."""

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from .errors import NoResultError, ServiceError, from_problem
from .follow import Follower
from .parcel import log_parcel, robot_parcel
from .records import Job, Log, Robot
from .result import Result
from .transport import Transport, segment

Progress = Callable[[str, float], None]
RobotLike = Robot | str | Path | Mapping[str, object]
LogLike = Log | object
"""A log that the service keeps, or what `Client.upload` takes."""


class Client:
    """Reach one service; use it in a ``with`` statement, or close it.

    Parameters
    ----------
    url
        Address of the service, ``http://127.0.0.1:8000``.
    key
        Secret of a key, where the service asks for one.
    timeout_s
        Longest wait for one answer, s.

    Raises
    ------
    ServiceError
        Every method: `NoAnswerError` if there is no answer, `RefusedError` if the service says no.
    """

    def __init__(self, url: str, key: str | None = None, *, timeout_s: float = 60.0) -> None:
        self._transport = Transport(url, key, timeout_s=timeout_s)
        self.url = self._transport.url

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, _kind: type[BaseException] | None, _error: BaseException | None, _trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the connections."""
        self._transport.close()

    def is_alive(self) -> bool:
        """Return whether the service answers."""
        try:
            self._transport.document("GET", "/healthz")
        except ServiceError:
            return False
        return True

    def robots(self) -> list[Robot]:
        """List the robots, built-in ones first."""
        return [Robot.from_document(robot) for robot in self._all("/v1/robots", "robots")]

    def robot(self, identity: str) -> Robot:
        """Read a robot with its description."""
        return Robot.from_document(self._transport.document("GET", f"/v1/robots/{segment(identity)}"))

    def add_robot(
        self,
        robot: Path | str | Mapping[str, object],
        *,
        base_link: str | None = None,
        tip_link: str | None = None,
        gravity: Sequence[float] | None = None,
    ) -> Robot:
        """Describe a robot: by a description, a file that holds one, or a URDF file.

        Parameters
        ----------
        base_link, tip_link
            Of a URDF, where not all of it is meant.
        gravity
            Of a URDF: gravitational acceleration in the base frame, m/s2.
        """
        parcel = robot_parcel(Path(robot) if isinstance(robot, str) else robot)
        part = {"base_link": base_link, "tip_link": tip_link}
        params = {name: value for name, value in part.items() if value is not None}
        if gravity is not None:
            params["gravity"] = ",".join(repr(float(component)) for component in gravity)
        return Robot.from_document(
            self._transport.document(
                "POST", "/v1/robots", params=params, content=parcel.content, media_type=parcel.media_type
            )
        )

    def base_parameters(self, robot: RobotLike) -> dict[str, Any]:
        """Say which combinations of parameters any motion of a robot can distinguish."""
        return self._transport.document("GET", f"/v1/robots/{segment(self._robot(robot))}/base-parameters")

    def audit(
        self,
        robot: RobotLike,
        logs: LogLike | Sequence[LogLike] = (),
        options: Mapping[str, object] | None = None,
    ) -> dict[str, Any]:
        """Audit a robot's description, by itself or against logs; see docs/audit.md.

        Raises
        ------
        NoResultError
            If the job of an audit against logs ends without a result.
        """
        if not isinstance(logs, Sequence) or isinstance(logs, str) or logs:
            job = self.submit("audit", robot, logs, options)
            self.finish(job)
            document: dict[str, Any] = json.loads(self.result_bytes(job))
            return document
        path = f"/v1/robots/{segment(self._robot(robot))}/audit"
        content = json.dumps({"options": dict(options or {})}).encode()
        return self._transport.document("POST", path, content=content, media_type="application/json")

    def upload(self, log: object, *, name: str = "", mapping: Mapping[str, object] | None = None) -> Log:
        """Upload a log.

        Parameters
        ----------
        log
            A file in any format of docs/logs.md; a data frame with the same columns; or a mapping of arrays:
            ``{"time": t, "q": q, "tau": tau}``, samples by joints, in SI.
        name
            What it is called; the file's name if empty.
        mapping
            Which column is what in which unit, or ``{"profile": "ur-rtde"}``; default names need none.
        """
        parcel = log_parcel(log, name)
        params = {"name": parcel.name} | ({"mapping": json.dumps(mapping)} if mapping else {})
        return Log.from_document(
            self._transport.document(
                "POST", "/v1/logs", params=params, content=parcel.content, media_type=parcel.media_type
            )
        )

    def identify(
        self, robot: RobotLike, logs: LogLike | Sequence[LogLike], options: Mapping[str, object] | None = None
    ) -> Job:
        """Ask for an identification; the same request is the same job."""
        return self.submit("identify", robot, logs, options)

    def diagnose(
        self, robot: RobotLike, logs: LogLike | Sequence[LogLike], options: Mapping[str, object] | None = None
    ) -> Job:
        """Ask for a diagnosis: what the simulation gets wrong, and why."""
        return self.submit("diagnose", robot, logs, options)

    def check(
        self, robot: RobotLike, logs: LogLike | Sequence[LogLike], options: Mapping[str, object] | None = None
    ) -> dict[str, Any]:
        """Check a set-up, and give the document with conflicts and what the logs show; see docs/conflicts.md.

        Raises
        ------
        NoResultError
            If it ends without a result.
        """
        job = self.submit("check", robot, logs, options)
        self.finish(job)
        document: dict[str, Any] = json.loads(self.result_bytes(job))
        return document

    def submit(
        self,
        kind: str,
        robot: RobotLike,
        logs: LogLike | Sequence[LogLike],
        options: Mapping[str, object] | None = None,
    ) -> Job:
        """Create a job.

        Parameters
        ----------
        robot
            A robot of the service, its id or built-in name, a description, or the `Path` of one.
        logs
            One log or several; what `upload` takes is uploaded.
        options
            See docs/options.md.
        """
        several = logs if isinstance(logs, list | tuple) else [logs]
        request = {
            "kind": kind,
            "robot": self._robot(robot),
            "logs": [log.id if isinstance(log, Log) else self.upload(log).id for log in several],
            "options": dict(options or {}),
        }
        content = json.dumps(request).encode()
        return Job.from_document(
            self._transport.document("POST", "/v1/jobs", content=content, media_type="application/json")
        )

    def jobs(self) -> list[Job]:
        """List the jobs, the newest first."""
        return [Job.from_document(job) for job in self._all("/v1/jobs", "jobs")]

    def job(self, identity: str) -> Job:
        """Read how far a job is."""
        return Job.from_document(self._transport.document("GET", f"/v1/jobs/{segment(identity)}"))

    def wait(self, job: Job | str, tell: Progress | None = None) -> Result:
        """Follow a job to its end and give its result.

        Parameters
        ----------
        tell
            Called with stage and fraction (0 to 1) at every change; `app.client.progress.bar` draws them.

        Raises
        ------
        NoResultError
            If it ends without a result.
        """
        self.finish(job, tell)
        return self.result(job)

    def finish(self, job: Job | str, tell: Progress | None = None) -> None:
        """Follow a job of any kind until it is successful; `result_bytes` reads its result.

        Raises
        ------
        NoResultError
            If it ends without a result.
        """
        for now in Follower(self._transport, _identity(job)).changes():
            if tell is not None:
                tell(now.stage if now.state == "running" else now.state, now.fraction)
            if now.finished and now.state != "successful":
                raise from_problem(NoResultError, now.problem or _dismissal(now))

    def cancel(self, job: Job | str) -> None:
        """Dismiss a job, which ends its computation; one that has finished keeps its result."""
        if not self.job(_identity(job)).finished:
            self._transport.document("DELETE", f"/v1/jobs/{segment(_identity(job))}")

    def result(self, job: Job | str) -> Result:
        """Read the result of a finished job."""
        return Result.from_document(json.loads(self.result_bytes(job)))

    def result_bytes(self, job: Job | str) -> bytes:
        """Read the result document as the service stores it."""
        return self._transport.content(f"/v1/jobs/{segment(_identity(job))}/results")

    def report(self, job: Job | str) -> bytes:
        """Read the report: one HTML file that opens offline."""
        return self._transport.content(f"/v1/jobs/{segment(_identity(job))}/report")

    def export(self, job: Job | str, name: str) -> bytes:
        """Read the identified robot as a file: ``robot.urdf``, ``robot.xml`` ...; see docs/export.md."""
        return self._transport.content(f"/v1/jobs/{segment(_identity(job))}/results/{segment(name)}")

    def _robot(self, robot: RobotLike) -> str:
        if isinstance(robot, Robot):
            return robot.id
        return robot if isinstance(robot, str) else self.add_robot(robot).id

    def _all(self, path: str, name: str) -> list[dict[str, Any]]:
        """Turn the pages of a list."""
        found: list[dict[str, Any]] = []
        cursor: dict[str, str] = {}
        while True:
            page = self._transport.document("GET", path, params=cursor)
            found += page[name]
            if page["next"] is None:
                return found
            cursor = {"cursor": str(page["next"])}


def _identity(job: Job | str) -> str:
    return job if isinstance(job, str) else job.id


def _dismissal(job: Job) -> dict[str, object]:
    return {
        "type": job.state,
        "cause": f"the job was {job.state}",
        "evidence": {"job": job.id},
        "remedy": "ask for it again",
    }
