"""Define the kind `identify`: the parameters of a robot from its logs."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, cast

from ...core.export.formats import FORMATS
from ...core.report.page.running import Origin
from ..store.records import Document
from .kind import Inputs, JobKind, PlannedJob, Progress, Words

if TYPE_CHECKING:
    from pydantic import BaseModel
    from rich.console import Console

    from ...core.identification.admission import KnownLog
    from ...core.identification.options import IdentifyOptions
    from ...core.study import IdentifyRequest

EXAMPLE_LOG_ID = "log-5d5467910a83d6dbb2b0"
"""Follows from the bytes of examples/yumi/log.csv, uploaded under its own name; a test keeps them equal."""


class Identify(JobKind["IdentifyOptions"]):
    """Identify a robot from its logs."""

    name = "identify"
    words = Words(
        title="Identification",
        hint=(
            "Identifiable combinations of masses, inertias and friction, with standard deviations. "
            "Takes seconds."
        ),
        help="Identify physically consistent parameters of a robot from its logs, with standard deviations.",
        commands=(
            "identify yumi-left examples/yumi/log.csv",
            "identify examples/yumi/robot.json examples/yumi/log.csv --set bootstrap.draws=0 --json",
            "identify robot.urdf examples/yumi/log.csv --tip-link joint_7 --set bootstrap.draws=0",
        ),
        summary="Identify the arm from the first example log",
        request={"kind": "identify", "robot": "yumi-left", "logs": [EXAMPLE_LOG_ID], "options": {}},
    )
    preload: ClassVar[tuple[str, ...]] = (
        "veritorque.core.study",
        "veritorque.core.conflicts.doubted",
        "veritorque.core.document.model.reference",
        "veritorque.core.numerics.decays",
        "veritorque.core.numerics.elementwise",
        "veritorque.core.regressor.kernel",
        "scipy.interpolate",
        "scipy.signal",
    )
    artifacts = FORMATS
    has_report = True

    @property
    def result(self) -> "type[BaseModel]":
        """Give the model of its result document."""
        from ..schemas.results import ResultDocument

        return ResultDocument

    def read_options(self, options: Document) -> "IdentifyOptions":
        """Read the options of an identification."""
        from ...core.identification.options import parse_options

        return parse_options(options)

    def admit(self, job: PlannedJob, options: "IdentifyOptions") -> None:
        """Refuse options that the robot's model or the logs do not allow, by the logs' summaries."""
        from ...core.identification.admission import admit

        admit(options, job.model(options.terms), [_known_log(log) for log in job.logs])

    def compute(self, inputs: Inputs, progress: Progress) -> Document:
        """Identify the robot."""
        from ...core import study

        return study.identify(request_of(inputs), progress)

    def report(self, document: dict[str, Any], traces: Path | None, origin: Origin | None = None) -> str:
        """Write the report of an identified robot."""
        from .report_page import report_page

        return report_page(document, traces, origin)

    def show(self, console: "Console", document: Mapping[str, Any]) -> None:
        """Print the parameters, how well each is known, and the errors per joint."""
        from ..terminal.output.tables import print_result

        print_result(console, document)


def request_of(inputs: Inputs) -> "IdentifyRequest":
    """Write the inputs of a job as the request that `core.study` takes."""
    from ...core import study

    return study.IdentifyRequest(inputs.robot, inputs.logs, inputs.options, inputs.reference, inputs.traces)


def _known_log(summary: Document) -> "KnownLog":
    from ...core.identification.admission import KnownLog

    defects = cast("list[dict[str, Any]]", summary["defects"])
    return KnownLog(
        str(summary["name"]),
        tuple(cast("list[str]", summary["channels"])),
        cast("float", summary["rate_hz"]),
        cast("float", summary["duration_s"]),
        cast("int", summary["samples"]),
        1 + sum(defect["count"] for defect in defects if defect["kind"] == "gap"),
        str(summary["sha256"]),
    )
