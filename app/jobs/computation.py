"""Describe a computation and its outcome in plain types that travel between processes."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from ..kinds.kind import Progress
from ..store.records import Document


@dataclass(frozen=True)
class LogBlob:
    """Name the blob of a log, and how to read it."""

    sha256: str
    """Digest of the bytes as they were uploaded."""
    name: str
    """The log's name."""
    mapping: Document | None
    """Which column is what; None for the default names."""


@dataclass(frozen=True)
class Computation:
    """Describe a computation completely, by values and digests: equal computations give equal results."""

    kind: str
    robot: Document
    """The robot's description."""
    logs: tuple[LogBlob, ...]
    options: Document
    reference: str | None = None
    """Digest of the earlier result that the options name; None where they name none."""

    @property
    def digests(self) -> tuple[str, ...]:
        """List the blobs that it reads."""
        reference = () if self.reference is None else (self.reference,)
        return (*(log.sha256 for log in self.logs), *reference)


@dataclass(frozen=True)
class Workspace:
    """Name the local files of one run of a computation."""

    files: Mapping[str, Path] = field(default_factory=dict)
    """The blobs that it reads, by digest."""
    traces: Path | None = None
    """File to write the torques and residuals of every sample to; None where they are not kept."""


Work = Callable[[Computation, Workspace, Progress], Document]
Rehearse = Callable[[Progress], None]


@dataclass(frozen=True)
class Finished:
    """Carry the result document, as the bytes that are stored and sent."""

    result: bytes


@dataclass(frozen=True)
class Failed:
    """Carry the problem document that says why there is no result."""

    problem: Document


@dataclass(frozen=True)
class Died:
    """Carry the problem document of a process that ended without a result; the job may be tried again."""

    problem: Document


@dataclass(frozen=True)
class Stopped:
    """Say that the computation was stopped on demand."""


Outcome = Finished | Failed | Died | Stopped


@dataclass(frozen=True)
class Ended:
    """Describe how a computation ended, for metrics and the service's log."""

    kind: str
    """What was computed."""
    outcome: str
    """``successful``, ``failed``, ``died`` or ``stopped``."""
    seconds: float
    """How long it took."""
    problem: str | None = None
    """Kind of the problem, where there is one."""
