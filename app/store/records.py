"""Hold what the store gives back: plain frozen records, which know nothing of tables or of HTTP."""

from dataclasses import dataclass
from typing import Literal

State = Literal["accepted", "running", "successful", "failed", "dismissed"]
Document = dict[str, object]
UNFINISHED: tuple[State, ...] = ("accepted", "running")


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


@dataclass(frozen=True)
class LogRecord:
    """Keep a log: the summary that clients see; the samples stay in the uploaded file."""

    id: str
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


@dataclass(frozen=True)
class JobRecord:
    """Keep a job: what was asked for, how far it is, and how it ended."""

    id: str
    request: JobRequestRecord
    state: State
    stage: str
    fraction: float
    attempts: int
    version: int
    problem: Document | None
    result_sha256: str | None
    created_at: str
    started_at: str | None
    finished_at: str | None

    @property
    def finished(self) -> bool:
        """Tell whether the state is final."""
        return self.state not in UNFINISHED
