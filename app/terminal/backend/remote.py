"""Have a service compute: upload, submit, follow, and dismiss the job if the command is interrupted."""

from contextlib import suppress
from functools import partial
from pathlib import Path

from ....core.errors import LogError
from ...client.client import Client
from ...client.errors import ServiceError
from ...client.parcel import require_file
from ...client.records import Robot
from ..output.files import means_a_file, save
from ..output.streams import note, note_suspicions
from .protocol import WHOLE, Document, FromUrdf, Progress, Study, require_whole


class RemoteBackend:
    """Do the work on a service."""

    def __init__(self, client: Client) -> None:
        self._client = client

    def robots(self) -> list[Document]:
        """List the robots of the service."""
        return [_summary(robot) for robot in self._client.robots()]

    def robot(self, given: str, part: FromUrdf = WHOLE) -> Document:
        """Read a robot of the service, or describe one to it."""
        robot = self._robot(given, part)
        return _summary(robot) | {
            "suspicions": list(robot.suspicions),
            "description": dict(robot.description),
        }

    def base_parameters(self, given: str, part: FromUrdf = WHOLE) -> Document:
        """Say what motion of a robot can distinguish."""
        return self._client.base_parameters(self._robot(given, part))

    def audit(self, given: str, part: FromUrdf, options: Document) -> Document:
        """Audit a robot's description without a log."""
        return self._client.audit(self._robot(given, part), options=options)

    def run(self, study: Study, progress: Progress, report: Path | None) -> bytes:
        """Compute; an interruption dismisses the job."""
        for path in study.logs:
            require_file(path, LogError)
        robot = self._robot(study.robot, study.part)
        note_suspicions(robot.suspicions)
        progress("upload", 0.0)
        logs = [self._client.upload(path, mapping=study.mapping) for path in study.logs]
        submit = partial(self._client.submit, study.kind, robot, logs, study.options)
        job = None
        try:
            job = submit()
            note(f"job {job.id}")
            self._client.finish(job, progress)
        except KeyboardInterrupt:
            with suppress(ServiceError):
                self._client.cancel(job or submit())  # the same request is the same job
            raise
        if report is not None:
            save(report, self._client.report(job))
        return self._client.result_bytes(job)

    def _robot(self, given: str, part: FromUrdf) -> Robot:
        if means_a_file(given):
            return self._client.add_robot(Path(given), **vars(part))
        require_whole(given, part)
        return self._client.robot(given)


def _summary(robot: Robot) -> Document:
    return {"id": robot.id, "name": robot.name, "joints": robot.joints, "built_in": robot.built_in}
