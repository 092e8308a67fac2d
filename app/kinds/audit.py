"""Define the kind `audit`: which described bodies are impossible, and which entries logs contradict."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar

from ...core.errors import OptionError
from ...core.export.formats import Format
from ..store.records import Document
from .identify import EXAMPLE_LOG_ID, Identify
from .kind import Alarm, Inputs, Progress, Words

if TYPE_CHECKING:
    from pydantic import BaseModel
    from rich.console import Console

    from ...core.identification.options import IdentifyOptions

MAKERS_MASS = "makers_mass"
"""Option: mass of the robot by its data sheet, kg."""
HEAVIEST = 1e5
"""Largest mass that is taken for one, kg."""


class Audit(Identify):
    """Audit the bodies of a robot's description against logs."""

    name = "audit"
    words = Words(
        title="Audit of the description",
        hint=(
            "Which masses, mass centres and inertias of the robot's description the log "
            "contradicts, with a corrected description. Takes seconds."
        ),
        help="Audit the bodies of a description against logs; `robots audit` also does it without a log.",
        commands=("audit robot.urdf examples/yumi/log.csv --tip-link joint_7 --fail-on-findings --json",),
        summary="Audit the arm's description against the first example log",
        request={"kind": "audit", "robot": "yumi-left", "logs": [EXAMPLE_LOG_ID], "options": {}},
        flags={},
        alarm=Alarm(
            "fail_on_findings",
            "Exit with 1 if a body is impossible or contradicted.",
            lambda document: bool(document["remarks"] or document["contradicted"]),
        ),
    )
    preload = ("veritorque.core.robot_audit",)
    artifacts: ClassVar[Mapping[str, Format]] = {}
    has_report = False

    @property
    def result(self) -> "type[BaseModel]":
        """Give the model of its result document."""
        from ..schemas.audit import AuditDocument

        return AuditDocument

    def read_options(self, options: Document) -> "IdentifyOptions":
        """Read the options of an identification, and the mass by the data sheet."""
        read_makers_mass(options)
        return super().read_options(_of_identification(options))

    def compute(self, inputs: Inputs, progress: Progress) -> Document:
        """Audit the description."""
        from ...core.robot_audit import audit_robot
        from ...core.study import IdentifyRequest

        request = IdentifyRequest(inputs.robot, inputs.logs, _of_identification(inputs.options))
        return audit_robot(request, read_makers_mass(inputs.options), progress)

    def show(self, console: "Console", document: Mapping[str, Any]) -> None:
        """Print what is odd, and what the logs contradict."""
        from ..terminal.output.audit import print_audit

        print_audit(console, document)


def audit_description(description: Document, options: Document) -> Document:
    """Audit a description without a log.

    Raises
    ------
    OptionError
        If there is another option than the mass by the data sheet.
    RobotError
        If the description cannot be used.
    """
    from ...core.robot.description import robot_from_description
    from ...core.robot_audit import audit_description as audited

    others = sorted(_of_identification(options))
    if others:
        raise OptionError(
            f"an audit without a log has no option {others[0]}",
            evidence={"given": others, "known": [MAKERS_MASS]},
            remedy="leave it out, or give a log",
        )
    return audited(robot_from_description(description), read_makers_mass(options))


def read_makers_mass(options: Document) -> float | None:
    """Read the mass of the robot by its data sheet, kg.

    Raises
    ------
    OptionError
        If it is no mass.
    """
    given = options.get(MAKERS_MASS)
    if given is None:
        return None
    if isinstance(given, bool) or not isinstance(given, int | float) or not 0.0 < given <= HEAVIEST:
        raise OptionError(
            f"{MAKERS_MASS} is no mass",
            evidence={"pointer": f"/options/{MAKERS_MASS}", "given": str(given)[:80]},
            remedy=f"give the robot's mass by its data sheet in kg, at most {HEAVIEST:g}",
        )
    return float(given)


def _of_identification(options: Document) -> Document:
    return {name: value for name, value in options.items() if name != MAKERS_MASS}
