"""Define what commands ask of a backend: this process, which works on files, or a service.

Both give the documents of the API, so that what is printed does not depend on where it was computed.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

from ....core.errors import OptionError

Document = dict[str, Any]
Progress = Callable[[str, float], None]


@dataclass(frozen=True)
class FromUrdf:
    """Say which part of a URDF is meant, and where down is (m/s2 in the base frame)."""

    base_link: str | None = None
    tip_link: str | None = None
    gravity: tuple[float, ...] | None = None


WHOLE = FromUrdf()


@dataclass(frozen=True)
class Study:
    """Create a job."""

    kind: str
    """Name of a kind of job."""
    robot: str
    """What `Backend.robot` takes."""
    logs: tuple[Path, ...]
    mapping: Mapping[str, object] | None = None
    """Of all logs; None for the default names."""
    options: Mapping[str, object] = field(default_factory=dict)
    part: FromUrdf = WHOLE
    """Of the robot, where it is a URDF."""


def require_whole(given: str, part: FromUrdf) -> None:
    """Return where nothing was asked of a robot that only a URDF can be asked for.

    Raises
    ------
    OptionError
        If something was.
    """
    asked = {name: value for name, value in vars(part).items() if value is not None}
    if asked:
        raise OptionError(
            f"{given} is no URDF, and states its links and gravity itself",
            evidence={"given": asked},
            remedy="leave these options out, or change the description",
        )


class Backend(Protocol):
    """Do the work of the commands."""

    def robots(self) -> list[Document]:
        """List the robots as `GET /v1/robots` does."""

    def robot(self, given: str, part: FromUrdf = WHOLE) -> Document:
        """Read a robot as `GET /v1/robots/{id}` gives it."""

    def base_parameters(self, given: str, part: FromUrdf = WHOLE) -> Document:
        """Say what motion of a robot can distinguish."""

    def audit(self, given: str, part: FromUrdf, options: Document) -> Document:
        """Audit a robot's description without a log."""

    def run(self, study: Study, progress: Progress, report: Path | None) -> bytes:
        """Compute; give the result document, and write the report where one is wanted."""
