"""Define the kind `compare`: several estimators on the same logs, in one table."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar

from ...core.export.comparison import FORMATS
from ...core.export.formats import Format
from ..store.records import Document
from .identify import EXAMPLE_LOG_ID, Identify, request_of
from .kind import Inputs, Progress, Words

if TYPE_CHECKING:
    from pydantic import BaseModel
    from rich.console import Console

    from ...core.identification.options import IdentifyOptions


class Compare(Identify):
    """Fit one set of logs by several estimators."""

    name = "compare"
    compares = True
    words = Words(
        title="Comparison of estimators",
        hint=(
            "Least squares, the semidefinite programme, instrumental variables and simulated columns on the "
            "same log: parameters, held-out error, simulated motion, cost."
        ),
        help="Fit the same logs by several estimators, and compare parameters, errors and cost.",
        commands=(
            'compare yumi-left examples/yumi/log.csv --set \'compare=["sdp", "iv", "didim"]\'',
            'compare yumi-left examples/yumi/log.csv --set \'compare=["sdp", "iv"]\' --json',
        ),
        summary="Compare estimators on the first example log",
        request={
            "kind": "compare",
            "robot": "yumi-left",
            "logs": [EXAMPLE_LOG_ID],
            "options": {"compare": ["sdp", "iv"]},
        },
    )
    preload = ("veritorque.core.estimator_comparison",)
    artifacts: ClassVar[Mapping[str, Format]] = FORMATS
    has_report = False

    @property
    def result(self) -> "type[BaseModel]":
        """Give the model of its result document."""
        from ..schemas.comparison import ComparisonDocument

        return ComparisonDocument

    def read_options(self, options: Document) -> "IdentifyOptions":
        """Read the options of every estimator; gives those by which all of them begin."""
        from ...core.identification.comparison_options import read_options

        return read_options(options)

    def compute(self, inputs: Inputs, progress: Progress) -> Document:
        """Fit by every estimator."""
        from ...core.estimator_comparison import compare_estimators

        return compare_estimators(request_of(inputs), progress)

    def show(self, console: "Console", document: Mapping[str, Any]) -> None:
        """Print the table."""
        from ..terminal.output.comparison import print_comparison

        print_comparison(console, document)
