"""Define the kind `check`: whether robot and logs belong together, and what the logs can show."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar

from ...core.export.formats import Format
from ..store.records import Document
from .identify import EXAMPLE_LOG_ID, Identify, request_of
from .kind import Alarm, Inputs, Progress, Words

if TYPE_CHECKING:
    from pydantic import BaseModel
    from rich.console import Console


class Check(Identify):
    """Check a robot and its logs before anything is identified."""

    name = "check"
    words = Words(
        title="Set-up check",
        hint=(
            "Whether robot and log belong together: units, signs, order, gravity; and which parameters and "
            "causes the log can show. Takes about a second."
        ),
        help="Check whether a robot and its logs belong together, and what these logs can show.",
        commands=(
            "check yumi-left examples/yumi/log.csv",
            "check robot.urdf examples/yumi/log.csv --tip-link joint_7 --fail-on-conflicts --json",
        ),
        summary="Check the arm against the first example log",
        request={"kind": "check", "robot": "yumi-left", "logs": [EXAMPLE_LOG_ID], "options": {}},
        alarm=Alarm(
            "fail_on_conflicts",
            "Exit with 1 if robot and logs disagree, or anything is doubtful.",
            lambda document: document["agreement"] != "yes",
        ),
    )
    preload = ("veritorque.core.setup_check",)
    artifacts: ClassVar[Mapping[str, Format]] = {}
    has_report = False

    @property
    def result(self) -> "type[BaseModel]":
        """Give the model of its result document."""
        from ..schemas.setup_check import CheckDocument

        return CheckDocument

    def compute(self, inputs: Inputs, progress: Progress) -> Document:
        """Check the set-up."""
        from ...core.setup_check import check_setup

        return check_setup(request_of(inputs), progress)

    def show(self, console: "Console", document: Mapping[str, Any]) -> None:
        """Print conflicts, errors, and what the logs can show."""
        from ..terminal.output.setup_check import print_check

        print_check(console, document)
