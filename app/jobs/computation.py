"""Say what is computed and how it can end, in plain types that travel between processes."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from ..store.records import Document

Progress = Callable[[str, float], None]


@dataclass(frozen=True)
class LogFile:
    """Name the file of a log and how to read it.

    Attributes
    ----------
    path
        The bytes as they were uploaded.
    name
        The log's name.
    mapping
        Which column is what; None for the default names.
    sha256
        Hash of the bytes.
    """

    path: Path
    name: str
    mapping: Document | None
    sha256: str


@dataclass(frozen=True)
class Glance:
    """Say what of a log is looked at.

    Attributes
    ----------
    channels
        Their names.
    points
        The most points per trace.
    begin, end
        Stretch of the log's clock, s; None for its own ends.
    """

    channels: tuple[str, ...]
    points: int
    begin: float | None = None
    end: float | None = None


@dataclass(frozen=True)
class Computation:
    """Describe a computation completely: equal computations give equal results.

    Attributes
    ----------
    reference
        File of the earlier result that the option of that name means, where it means one.
    traces
        File to write what is computed instant by instant to, where it is kept.
    """

    kind: str
    robot: Document
    logs: tuple[LogFile, ...]
    options: Document
    reference: Path | None = None
    traces: Path | None = None


Work = Callable[[Computation, Progress], Document]
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
    """Carry the problem document that says how a computation ended without a word; it may be tried again."""

    problem: Document


@dataclass(frozen=True)
class Stopped:
    """Say that the computation was stopped on demand."""


Outcome = Finished | Failed | Died | Stopped


@dataclass(frozen=True)
class Ended:
    """Say how a computation went, for whoever counts.

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
