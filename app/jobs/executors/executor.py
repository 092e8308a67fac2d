"""Define what an executor does: run computations that can be followed, stopped and timed out."""

from threading import Event
from typing import Protocol

from ...kinds.kind import Progress
from ..computation import Computation, Outcome, Workspace


class Executor(Protocol):
    """Run computations, several at the same time where several threads ask for it."""

    def prepare(self) -> None:
        """Load what the first computation would otherwise wait for."""

    def run(
        self, task: Computation, workspace: Workspace, *, progress: Progress, stop: Event, timeout_s: float
    ) -> Outcome:
        """Run a computation to its end, until `stop` is set, or until the time is over (s)."""

    def close(self) -> None:
        """Release all that was prepared, once no computation runs any more."""
