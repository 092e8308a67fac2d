"""Take robots and logs in, and find them again: documents and bytes become records here, or problems.

Everything here may take a while and is called from worker threads, never on the event loop.
"""

from dataclasses import replace

from ...core.log.formats.content import recognise
from ...core.robot.model import RobotModel
from ...core.robot.plausibility import plausibility_warnings
from ..inspection.inspector import Inspector
from ..inspection.log_reading import ChannelSelection, LogFile
from ..kinds.base_parameters import base_parameters
from ..problems import Problem
from ..store.blobs.incoming import CHUNK_BYTES, Incoming
from ..store.records import Document, LogRecord, RobotRecord
from ..store.store import TenantStore
from .log_names import log_name
from .robot_descriptions import read_description, read_urdf


class Catalogue:
    """Know all robots and logs of a tenant, and the robots that are built in.

    Parameters
    ----------
    store
        What belongs to the tenant.
    inspector
        Reads uploaded logs.
    built_in
        The built-in robots by id.
    base_parameters
        What was computed before, by the id of a robot, which is a hash of its description.
    """

    def __init__(
        self,
        store: TenantStore,
        inspector: Inspector,
        built_in: dict[str, RobotRecord],
        base_parameters: dict[str, Document],
    ) -> None:
        self._store, self._inspector = store, inspector
        self.built_in, self._base_parameters = built_in, base_parameters

    def add_description(self, description: object) -> RobotRecord:
        """Keep a robot that is described by the service's own document.

        Raises
        ------
        RobotError
            If the description cannot be used.
        """
        return self._add(*read_description(description))

    def add_urdf(
        self,
        text: bytes,
        *,
        base_link: str | None = None,
        tip_link: str | None = None,
        gravity: tuple[float, ...] | None = None,
    ) -> RobotRecord:
        """Keep a robot that is described by a URDF.

        Raises
        ------
        RobotError
            If the URDF cannot be used.
        """
        return self._add(*read_urdf(text, base_link=base_link, tip_link=tip_link, gravity=gravity))

    def robot(self, identity: str, *, named_in_body: bool = False) -> RobotRecord:
        """Find a robot.

        Raises
        ------
        Problem
            If there is none (404, or 422 where the body of the request names it).
        """
        found = self.find_robot(identity)
        if found is None:
            raise _missing("robot", identity, named_in_body=named_in_body)
        return found

    def find_robot(self, identity: str) -> RobotRecord | None:
        """Find a robot; None where there is none."""
        return self.built_in.get(identity) or self._store.robots.get(identity)

    def robots(self, *, limit: int, before: int | None = None) -> list[RobotRecord]:
        """List robots, the newest first; built-in ones stand on the first page, before all others."""
        fixed = [] if before is not None else list(self.built_in.values())
        return fixed + self._store.robots.page(limit=limit, before=before)

    def remove_robot(self, identity: str) -> None:
        """Delete a robot.

        Raises
        ------
        Problem
            If there is none (404), or it is built in (409).
        """
        robot = self.robot(identity)
        if robot.built_in:
            raise Problem(
                "built-in",
                f"{robot.id} is built in and cannot be deleted",
                evidence={"robot": robot.id},
                remedy="delete only robots that were created by a request",
            )
        self._store.robots.remove(robot.id)

    def base_parameters(self, robot: RobotRecord) -> Document:
        """Say what motion of a robot can distinguish; computed once and cached."""
        if robot.id not in self._base_parameters:
            self._base_parameters[robot.id] = base_parameters(robot.description)
        return {"robot": robot.id} | self._base_parameters[robot.id]

    def add_log(
        self, incoming: Incoming, *, name: str, mapping: Document | None, media_type: str | None = None
    ) -> LogRecord:
        """Read an uploaded log once, and keep it if it can be used.

        What begins as no log does is refused without a process that would read it.

        Raises
        ------
        LogError, Problem
            If the log cannot be used; nothing is kept then.
        """
        incoming.flush()  # what is refused need never be on the disk
        recognise(incoming.path, media_type)
        log = LogFile(incoming.path, log_name(name), mapping, incoming.sha256)
        summary = self._inspector.summarise(log, size=incoming.size, media_type=media_type)
        return self._store.keep_log(incoming, mapping=mapping, summary=summary | {"bytes": incoming.size})

    def read_again(self, log: LogRecord, mapping: Document | None) -> LogRecord:
        """Read the bytes of a log with another mapping, and keep that as another log.

        Raises
        ------
        LogError, Problem
            If the mapping does not fit; nothing is kept then.
        DamagedError
            If the log is not what it was.
        """
        self._store.blobs.check(log.sha256)
        with self._store.blobs.open(log.sha256) as stored, self._store.blobs.receive() as incoming:
            while chunk := stored.read(CHUNK_BYTES):
                incoming.write(chunk)
            return self.add_log(incoming, name=str(log.summary["name"]), mapping=mapping)

    def trace_log(self, log: LogRecord, selection: ChannelSelection) -> bytes:
        """Draw channels of a log, as the document that is sent.

        Raises
        ------
        Problem
            If its bytes are not what they were.
        """
        mapping = log.summary["mapping"]
        known = mapping if isinstance(mapping, dict) else None
        size = int(str(log.summary["bytes"]))
        with self._store.blobs.local_copy(log.sha256) as path:
            file = LogFile(path, str(log.summary["name"]), known, log.sha256)
            return self._inspector.trace(file, selection, size=size)

    def log(self, identity: str, *, named_in_body: bool = False) -> LogRecord:
        """Find a log.

        Raises
        ------
        Problem
            If there is none (404, or 422 where the body of the request names it).
        """
        found = self.find_log(identity)
        if found is None:
            raise _missing("log", identity, named_in_body=named_in_body)
        return found

    def find_log(self, identity: str) -> LogRecord | None:
        """Find a log; None where there is none."""
        return self._store.logs.get(identity)

    def _add(self, robot: RobotModel, description: Document) -> RobotRecord:
        """Keep a robot; what is odd is said of what was sent now, not of what gave the same robot before."""
        suspicions = plausibility_warnings(robot)
        kept = self._store.robots.add(
            name=robot.name, joints=len(robot.joints), description=description, suspicions=suspicions
        )
        return replace(kept, suspicions=suspicions)


def _missing(what: str, identity: str, *, named_in_body: bool) -> Problem:
    return Problem(
        "unknown-reference" if named_in_body else "not-found",
        f"there is no {what} {identity}",
        evidence={what: identity},
        remedy=f"GET /v1/{what}s lists what there is",
    )
