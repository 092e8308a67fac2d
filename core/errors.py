"""Say why something cannot be done: one tree of errors, each with cause, evidence and remedy.

Every failure a caller can provoke ends here, so that a service can turn it into a problem document without
guessing.

    VeritorqueError
    |-- RobotError        the description of the robot cannot be used
    |-- LogError          the measured data cannot be used
    |-- OptionError       a request asks for something that does not exist or is not valid
    |-- ExcitationError   the motion cannot tell what was asked of it
    `-- SolverError       the optimiser stopped without an optimum
"""

from collections.abc import Mapping

Evidence = Mapping[str, object]


class VeritorqueError(Exception):
    """Tell what went wrong, what was seen, and what to do about it.

    Parameters
    ----------
    cause
        One sentence: what is wrong.
    evidence
        The numbers and names that show it.
    remedy
        One sentence: what to change.

    Examples
    --------
    >>> error = LogError("the log is empty", evidence={"rows": 0}, remedy="upload a motion")
    >>> str(error)
    'the log is empty (rows: 0); upload a motion'
    """

    def __init__(self, cause: str, *, evidence: Evidence | None = None, remedy: str = "") -> None:
        super().__init__(cause)
        self.cause = cause
        self.evidence: dict[str, object] = dict(evidence or {})
        self.remedy = remedy

    def __str__(self) -> str:
        """Join cause, evidence and remedy into one line."""
        seen = ", ".join(f"{name}: {value}" for name, value in self.evidence.items())
        line = f"{self.cause} ({seen})" if seen else self.cause
        return f"{line}; {self.remedy}" if self.remedy else line

    def __reduce__(self) -> tuple[object, ...]:
        """Let the error come back whole from a worker process."""
        return _rebuild, (type(self), self.cause, self.evidence, self.remedy)


class RobotError(VeritorqueError):
    """The description of the robot cannot be used."""


class LogError(VeritorqueError):
    """The measured data cannot be used."""


class OptionError(VeritorqueError):
    """A request asks for something that does not exist or is not valid."""


class ExcitationError(VeritorqueError):
    """The motion cannot tell what was asked of it."""


class SolverError(VeritorqueError):
    """The optimiser stopped without an optimum."""


def _rebuild(kind: type[VeritorqueError], cause: str, evidence: Evidence, remedy: str) -> VeritorqueError:
    return kind(cause, evidence=evidence, remedy=remedy)
