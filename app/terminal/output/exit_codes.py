"""List how commands end, in one place: scripts branch on these codes, and docs/terminal.md shows them."""

from enum import IntEnum

from ....core.errors import ExcitationError, SolverError, VeritorqueError
from ...client.errors import NoAnswerError, ServiceError


class Exit(IntEnum):
    """Say how a command ended."""

    DONE = 0
    """Success."""
    FOUND = 1
    """Findings, defects, or damage found by doctor."""
    INPUT = 2
    """Invalid command line, robot, log or option, or an output file that cannot be written."""
    NO_RESULT = 3
    """No result: insufficient excitation, no optimum, time or memory limit."""
    NO_SERVICE = 4
    """The service does not answer, refuses access, or fails."""
    MISTAKE = 5
    """Internal error."""
    INTERRUPTED = 130
    """Interrupted by Ctrl-C; a job on a service is dismissed."""


NO_RESULT = frozenset(
    {"excitation", "solver", "job-timeout", "job-memory", "computation-stopped", "dismissed", "job-failed"}
)
NO_SERVICE = frozenset(
    {"no-key", "no-scope", "other-site", "wrong-host", "too-slow", "too-many", "quota", "head-too-large"}
    | {"internal", "damaged", "not-ready", "stopping", "unavailable", "disk-full"}
)


def exit_of(kind: str) -> Exit:
    """Give the code that stands for a problem of a kind; see `app.problems.KINDS`.

    Examples
    --------
    >>> exit_of("log").name, exit_of("solver").name, exit_of("quota").name
    ('INPUT', 'NO_RESULT', 'NO_SERVICE')
    """
    if kind in NO_RESULT:
        return Exit.NO_RESULT
    return Exit.NO_SERVICE if kind in NO_SERVICE else Exit.INPUT


def exit_of_error(error: VeritorqueError) -> Exit:
    """Give the code that stands for an error."""
    if isinstance(error, NoAnswerError):
        return Exit.NO_SERVICE
    if isinstance(error, ServiceError):
        return exit_of(error.kind)
    return Exit.NO_RESULT if isinstance(error, ExcitationError | SolverError) else Exit.INPUT
