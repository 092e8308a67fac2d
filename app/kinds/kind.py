"""Define what a kind of job is: its options, admission, computation, result, and words.

The contract, the queue, the workers, the results and the terminal read a kind's properties and methods here
and ask nowhere for its name. A kind is loaded with every command, hence it imports numpy and the solver only
where it uses them.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeVar, cast

from ...core.export.formats import Format
from ...core.report.page.running import Origin
from ..problems import Problem
from ..store.records import Document

if TYPE_CHECKING:
    from pydantic import BaseModel
    from rich.console import Console

    from ...core.dynamics.model import DynamicModel
    from ...core.log.model import JointLog
    from ...core.robot.model import RobotModel

Progress = Callable[[str, float], None]
"""Takes the name of a stage and the fraction of the whole that is done."""
Options = TypeVar("Options")


@dataclass(frozen=True)
class Alarm:
    """Let a command end with exit code 1 where its result calls for it."""

    name: str
    """Name of the flag that asks for it, as a Python name."""
    help: str
    """What the terminal says of it."""
    is_raised: Callable[[Mapping[str, Any]], bool]
    """Decides by the result document."""


@dataclass(frozen=True)
class Words:
    """Hold what the contract, the terminal and the pages say of a kind."""

    title: str
    """Its name for people."""
    hint: str
    """What it gives and how long it takes, beside its title on a page."""
    help: str
    """One sentence, for the command."""
    commands: tuple[str, ...]
    """Example command lines."""
    summary: str
    """Title of the example request."""
    request: Document
    """The example request."""
    flags: Mapping[str, str] = field(default_factory=dict)
    """Options of the computation that have a flag of their own, with its help."""
    alarm: Alarm | None = None
    """When the command ends with exit code 1 although it has a result."""


@dataclass(frozen=True)
class PlannedJob:
    """Hold what is known of a job before anything is computed."""

    robot: Document
    """The robot's description."""
    logs: tuple[Document, ...]
    """Summaries of the logs."""
    options: Document
    """As they were sent."""
    model: Callable[[tuple[str, ...] | None], "DynamicModel"]
    """Gives the robot's dynamic model with the named torque terms; None for the standard ones."""
    earlier_result: Callable[[str], Document]
    """Gives the result document of an earlier job by its id, or refuses."""


@dataclass(frozen=True, eq=False)
class Inputs:
    """Hold what a computation takes."""

    robot: "RobotModel"
    logs: "tuple[JointLog, ...]"
    options: Document
    reference: Document | None = None
    """Result document of the earlier job that the options name."""
    traces: Path | None = None
    """File to write the torques and residuals of every sample to; None where they are not wanted."""


class JobKind(ABC, Generic[Options]):
    """Describe one kind of job; the methods with a body here are defaults."""

    name: ClassVar[str]
    """Its name in requests, results and commands."""
    takes_logs: ClassVar[bool] = True
    """Whether it is computed from logs, or from the robot alone."""
    takes_reference: ClassVar[bool] = False
    """Whether it has the option `reference`, an earlier result that logs are compared with."""
    compares: ClassVar[bool] = False
    """Whether it fits several estimators, which the option `compare` names, or one."""
    asks_joint: ClassVar[bool] = False
    """Whether it is about one joint, which the option `joint` names; it then has options of its own."""
    words: ClassVar[Words]
    """What the contract, the terminal and the pages say of it."""
    preload: ClassVar[tuple[str, ...]] = ()
    """Modules to load before the first computation."""
    artifacts: ClassVar[Mapping[str, Format]] = {}
    """The files that its result is also offered as."""
    has_report: ClassVar[bool] = False
    """Whether `report` writes one."""

    @property
    @abstractmethod
    def result(self) -> "type[BaseModel]":
        """Give the model of its result document, which is loaded when it is served or described."""

    @abstractmethod
    def read_options(self, options: Document) -> Options:
        """Read the options of a request.

        Raises
        ------
        OptionError
            If an option does not exist or is not valid.
        """

    @abstractmethod
    def compute(self, inputs: Inputs, progress: Progress) -> Document:
        """Compute the result document.

        Raises
        ------
        VeritorqueError
            If the robot, the logs or the options do not allow it.
        """

    def admit(self, job: PlannedJob, options: Options) -> None:
        """Refuse what cannot succeed, before anything is computed.

        Raises
        ------
        VeritorqueError, Problem
            If the robot, the logs or the options do not allow it.
        """

    def reference(self, _options: Document) -> str | None:
        """Name the earlier job whose result is needed; None where none is."""
        return None

    def report(self, document: dict[str, Any], traces: Path | None, origin: Origin | None = None) -> str:
        """Write the report of a result as one HTML page; without traces it has no figures over time."""
        raise NotImplementedError

    def show(self, console: "Console", document: Mapping[str, Any]) -> None:
        """Print a result for a person."""
        console.print_json(data=document)

    def read_example(self) -> Options:
        """Read the options of the example request."""
        return self.read_options(cast("Document", self.words.request["options"]))

    def require_logs(self, count: int) -> None:
        """Refuse a request that has logs where the kind takes none, or none where it takes some.

        Raises
        ------
        Problem
            If it does (422).
        """
        if self.takes_logs != bool(count):
            raise Problem(
                "request",
                f"a job of kind {self.name} {'needs a log' if self.takes_logs else 'takes no logs'}",
                evidence={"pointer": "/logs", "logs": count},
                remedy="name a log of GET /v1/logs" if self.takes_logs else "leave the logs out",
            )
