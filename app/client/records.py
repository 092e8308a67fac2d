"""Carry what a service answers as typed values: robots, logs with their defects, jobs."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Self

Document = Mapping[str, Any]


@dataclass(frozen=True)
class Robot:
    """Name a robot that the service knows.

    Attributes
    ----------
    joints
        How many there are.
    suspicions
        Probable mistakes in its description, which can be used all the same.
    description
        The description with every default filled in.
    """

    id: str
    name: str
    joints: int
    built_in: bool
    suspicions: tuple[str, ...] = ()
    description: Document = field(default_factory=dict, repr=False)

    @classmethod
    def from_document(cls, document: Document) -> Self:
        """Read an answer of `/v1/robots`."""
        return cls(
            **{name: document[name] for name in ("id", "name", "joints", "built_in")},
            suspicions=tuple(document.get("suspicions", ())),
            description=document.get("description", {}),
        )


@dataclass(frozen=True)
class Defect:
    """Name one thing that is wrong with usable data; see `core.log.model.Defect`."""

    kind: str
    channel: str
    joint: int | None
    count: int
    intervals: tuple[tuple[float, float], ...]
    statement: str
    level: float | None


@dataclass(frozen=True)
class Log:
    """Name a log that the service keeps, and say what is in it: duration in s, rate in Hz."""

    id: str
    name: str
    samples: int
    duration_s: float
    rate_hz: float
    joints: int
    channels: tuple[str, ...]
    ignored_columns: tuple[str, ...]
    defects: tuple[Defect, ...]

    @classmethod
    def from_document(cls, document: Document) -> Self:
        """Read an answer of `/v1/logs`."""
        return cls(
            **{name: document[name] for name in ("id", "name", "samples", "duration_s", "rate_hz", "joints")},
            channels=tuple(document["channels"]),
            ignored_columns=tuple(document["ignored_columns"]),
            defects=tuple(_defect(defect) for defect in document["defects"]),
        )


def _defect(document: Document) -> Defect:
    return Defect(
        **{name: document[name] for name in ("kind", "channel", "joint", "count", "statement", "level")},
        intervals=tuple((float(start), float(end)) for start, end in document["intervals"]),
    )


@dataclass(frozen=True)
class Job:
    """Say what was asked for and how far it is.

    Attributes
    ----------
    kind
        ``identify`` or ``diagnose``.
    robot, logs
        Ids.
    state
        ``accepted``, ``running``, ``successful``, ``failed`` or ``dismissed``.
    stage, fraction
        What is being computed, and the part of the whole that is done, 0 to 1.
    problem
        Why a failed job has no result.
    """

    id: str
    kind: str
    robot: str
    logs: tuple[str, ...]
    state: str
    stage: str
    fraction: float
    options: Document = field(default_factory=dict)
    problem: Document | None = field(default=None, repr=False)

    @property
    def finished(self) -> bool:
        """Return whether its state is final."""
        return self.state not in {"accepted", "running"}

    @classmethod
    def from_document(cls, document: Document) -> Self:
        """Read an answer of `/v1/jobs`."""
        return cls(
            **{name: document[name] for name in ("id", "kind", "robot", "state", "options", "problem")},
            logs=tuple(document["logs"]),
            stage=document["progress"]["stage"],
            fraction=float(document["progress"]["fraction"]),
        )
