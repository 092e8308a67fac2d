"""Hold what the store gives back: plain frozen records, which know nothing of tables or of HTTP."""

from dataclasses import dataclass
from typing import Literal, get_args

State = Literal["accepted", "running", "successful", "failed", "dismissed"]
STATES: tuple[State, ...] = get_args(State)
Document = dict[str, object]
UNFINISHED: tuple[State, ...] = ("accepted", "running")


@dataclass(frozen=True)
class Quota:
    """Bound what one tenant may have: unfinished jobs, and bytes of logs and results; None for no bound."""

    queued: int | None = None
    stored_bytes: int | None = None


UNBOUNDED = Quota()


@dataclass(frozen=True)
class RobotRecord:
    """Keep a robot: its description as core writes it, and what is suspicious about it."""

    id: str
    name: str
    joints: int
    built_in: bool
    description: Document
    suspicions: tuple[str, ...]
    created_at: str | None
    sequence: int | None = None


@dataclass(frozen=True)
class LogRecord:
    """Keep a log: the summary that clients see; the samples stay in the uploaded file."""

    id: str
    sequence: int
    sha256: str
    summary: Document
    created_at: str

    @property
    def joints(self) -> int:
        """Count the joints."""
        return int(str(self.summary["joints"]))


@dataclass(frozen=True)
class JobRequestRecord:
    """Keep what was asked for: the kind, the ids of robot and logs, and the options."""

    kind: str
    robot: str
    logs: tuple[str, ...]
    options: Document

    def document(self) -> Document:
        """Write it as a document."""
        return {"kind": self.kind, "robot": self.robot, "logs": list(self.logs), "options": self.options}


@dataclass(frozen=True)
class JobRecord:
    """Keep a job: what was asked for, how far it is, and how it ended."""

    tenant: str
    id: str
    sequence: int
    request: JobRequestRecord
    trace: str | None
    """Id of the trace that the request belonged to."""
    state: State
    stage: str
    fraction: float
    attempts: int
    token: int
    """How often it was taken; who took it earlier no longer has a say."""
    version: int
    """Grows with every change."""
    problem: Document | None
    result_sha256: str | None
    traces_sha256: str | None
    created_at: str
    started_at: str | None
    finished_at: str | None

    @property
    def finished(self) -> bool:
        """Return whether the state is final."""
        return self.state not in UNFINISHED
