"""Define the errors of the client: one tree, with cause, evidence and remedy.

Every one is a `ServiceError`: `NoAnswerError` if there is no answer, `RefusedError` if the service refuses,
`NoResultError` if a computation ended without a result.
"""

from collections.abc import Mapping
from typing import TypeVar

from ...core.errors import VeritorqueError

Said = TypeVar("Said", bound="ServiceError")
URN = "urn:veritorque:problem:"


class ServiceError(VeritorqueError):
    """The service did not do as it was asked.

    Attributes
    ----------
    kind
        Kind of the problem as docs/http.md lists them (``log``, ``no-key``, ...); empty where there is none.
    """

    kind = ""


class NoAnswerError(ServiceError):
    """No answer came, or none from the service."""


class RefusedError(ServiceError):
    """The service refused the request."""


class NoResultError(ServiceError):
    """The computation ended without a result."""


def from_problem(kind: type[Said], problem: Mapping[str, object]) -> Said:
    """Read a problem document; `detail` or `title` stand in for a cause that is missing.

    Examples
    --------
    >>> problem = {"type": "urn:veritorque:problem:log", "cause": "the log is empty", "evidence": {"rows": 0}}
    >>> error = from_problem(RefusedError, problem)
    >>> error.kind, str(error)
    ('log', 'the log is empty (rows: 0)')
    """
    cause = problem.get("cause") or problem.get("detail") or problem.get("title") or "no reason was given"
    evidence = problem.get("evidence")
    error = kind(
        str(cause),
        evidence=evidence if isinstance(evidence, Mapping) else {},
        remedy=str(problem.get("remedy") or ""),
    )
    error.kind = str(problem.get("type") or "").removeprefix(URN)
    return error
