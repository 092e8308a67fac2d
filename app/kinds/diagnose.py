"""Define the kind `diagnose`: what the simulation of a robot gets wrong, and why."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ..store.records import Document
from .identify import Identify, request_of
from .kind import Alarm, Inputs, PlannedJob, Progress, Words

if TYPE_CHECKING:
    from rich.console import Console

    from ...core.identification.options import IdentifyOptions

HIDDEN_LOG_ID = "log-a7b55ace1b0dad189dae"
"""Follows from the bytes of examples/yumi/hidden_log.csv, as `EXAMPLE_LOG_ID` does."""


class Diagnose(Identify):
    """Identify a robot, and name the causes of its simulation error."""

    name = "diagnose"
    takes_reference = True
    words = Words(
        title="Diagnosis",
        hint=(
            "Identification, then the causes of the remaining error: load-dependent friction, torque ripple, "
            "a spring, a delay, a payload. Takes longer."
        ),
        help=(
            "Identify a robot, then find the causes of its simulation error and what correcting "
            "them improves."
        ),
        commands=(
            "diagnose yumi-left examples/yumi/hidden_log.csv --report diagnosis.html --fail-on-findings",
            "diagnose robot.urdf examples/yumi/hidden_log.csv --tip-link joint_7 --gravity=0,0,-9.81",
        ),
        summary="Diagnose the second example log",
        request={
            "kind": "diagnose",
            "robot": "yumi-left",
            "logs": [HIDDEN_LOG_ID],
            "options": {"reference": None},
        },
        flags={"reference": "Reference: an earlier result (a file; with --url a job), or prior."},
        alarm=Alarm(
            "fail_on_findings",
            "Exit with 1 if there are findings.",
            lambda document: document["diagnosis"]["verdict"] != "nothing_found",
        ),
    )
    preload = (
        *Identify.preload,
        "veritorque.core.diagnosis.diagnose",
        "veritorque.core.document.diagnosis",
        "veritorque.core.extension.extend",
        "veritorque.core.extension.measure",
        "veritorque.core.extension.reserved",
        "veritorque.core.numerics.boosted_trees",
        "veritorque.core.numerics.power_density",
    )

    def read_options(self, options: Document) -> "IdentifyOptions":
        """Read the options of a diagnosis."""
        from ...core.identification.options import parse_diagnose_options

        return parse_diagnose_options(options)

    def admit(self, job: PlannedJob, options: "IdentifyOptions") -> None:
        """Refuse what an identification refuses, and a reference that the logs cannot be compared with."""
        super().admit(job, options)
        if options.reference is None:  # only a request that needs the solver waits until it is loaded
            return
        from ...core import study
        from ...core.robot.description import robot_from_description

        earlier = self._job_named_by(options)
        result = None if earlier is None else job.earlier_result(earlier)
        robot = robot_from_description(job.robot)
        study.check_reference(study.IdentifyRequest(robot, (), job.options, result))

    def reference(self, options: Document) -> str | None:
        """Name the job whose result the logs are compared with."""
        return self._job_named_by(self.read_options(options))

    def compute(self, inputs: Inputs, progress: Progress) -> Document:
        """Diagnose the simulation of the robot."""
        from ...core import study

        return study.diagnose(request_of(inputs), progress)

    def show(self, console: "Console", document: Mapping[str, Any]) -> None:
        """Print the findings, what each gains, and what is left unexplained."""
        from ..terminal.output.findings import print_diagnosis

        print_diagnosis(console, document)

    def _job_named_by(self, options: "IdentifyOptions") -> str | None:
        if options.reference is None:
            return None
        from ...core.identification.reference import PRIOR

        return None if options.reference == PRIOR else options.reference
