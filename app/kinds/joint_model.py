"""Define the kind `joint_model`: mass or inertia, friction and elasticity of one joint that moves alone."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar, cast

from ...core.export.formats import Format
from ..store.records import Document
from .identify import EXAMPLE_LOG_ID
from .kind import Inputs, JobKind, PlannedJob, Progress, Words

if TYPE_CHECKING:
    from pydantic import BaseModel
    from rich.console import Console

    from ...core.joint_model.options import JointOptions


class JointModel(JobKind["JointOptions"]):
    """Identify the continuous-time model of one joint."""

    name = "joint_model"
    asks_joint = True
    words = Words(
        title="Model of one joint",
        hint=(
            "Inertia, friction and, where the log shows it, stiffness and mode of one joint, from a log in "
            "which it moves alone. Takes seconds."
        ),
        help="Identify inertia, friction and elasticity of one joint from a log in which it moves alone.",
        commands=(
            "joint_model robot.json sweep.csv --set joint=1",
            "joint_model robot.json sweep.csv --set joint=1 --set estimator=clsrivc --json",
        ),
        summary="Identify the first joint",
        request={
            "kind": "joint_model",
            "robot": "yumi-left",
            "logs": [EXAMPLE_LOG_ID],
            "options": {"joint": 1, "order": "flexible", "estimator": "srivc"},
        },
    )
    preload = ("veritorque.core.joint_identification",)
    artifacts: ClassVar[Mapping[str, Format]] = {}

    @property
    def result(self) -> "type[BaseModel]":
        """Give the model of its result document."""
        from ..schemas.joint_model import JointModelDocument

        return JointModelDocument

    def read_options(self, options: Document) -> "JointOptions":
        """Read the options."""
        from ...core.joint_model.options import parse_joint_options

        return parse_joint_options(options)

    def admit(self, job: PlannedJob, options: "JointOptions") -> None:
        """Refuse a joint that is none, several logs, and a log that does not show its controller."""
        from ...core.joint_model.options import admit_joint

        channels = [cast("list[str]", log["channels"]) for log in job.logs]
        admit_joint(options, len(job.model(None).robot.joints), channels)

    def compute(self, inputs: Inputs, progress: Progress) -> Document:
        """Identify the joint."""
        from ...core.joint_identification import JointRequest, model_joint

        return model_joint(JointRequest(inputs.robot, inputs.logs, inputs.options), progress)

    def show(self, console: "Console", document: Mapping[str, Any]) -> None:
        """Print the parameters, and what is seen of the elasticity."""
        from ..terminal.output.joint_model import print_joint_model

        print_joint_model(console, document)
