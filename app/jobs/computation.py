"""Describe a computation and its outcome in plain types that travel between processes."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from ..kinds.kind import Progress
from ..store.records import Document


@dataclass(frozen=True)
class LogBlob:
    """Name the blob of a log, and how to read it.

    Attributes
    ----------
    sha256
        Digest of the bytes as they were uploaded.
    name
        The log's name.
    mapping
        Which column is what; None for the default names.
    """

    sha256: str
    name: str
    mapping: Document | None


@dataclass(frozen=True)
class Computation:
    """Describe a computation completely, by values and digests: equal computations give equal results.

    Attributes
    ----------
    robot
        The robot's description.
    reference
        Digest of the earlier result that the options name; None where they name none.
    """

    kind: str
    robot: Document
    logs: tuple[LogBlob, ...]
    options: Document
    reference: str | None = None

    @property
    def digests(self) -> tuple[str, ...]:
        """List the blobs that it reads."""
        reference = () if self.reference is None else (self.reference,)
        return (*(log.sha256 for log in self.logs), *reference)


@dataclass(frozen=True)
class Workspace:
    """Name the local files of one run of a computation.

    Attributes
    ----------
    files
        The blobs that it reads, by digest.
    traces
        File to write the torques and residuals of every sample to; None where they are not kept.
    """

    files: Mapping[str, Path] = field(default_factory=dict)
    traces: Path | None = None


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
    """Describe how a computation ended, for metrics and the service's log.

    Attributes
    ----------
    kind
        What was computed.
    outcome
        ``successful``, ``failed``, ``died`` or ``stopped``.
    seconds
        How long it took.
    problem
        Kind of the problem, where there is one.
    """

    kind: str
    outcome: str
    seconds: float
    problem: str | None = None
