"""Describe every failure as an RFC 9457 problem document: stable type, status, cause, evidence and remedy.

The table of kinds is the complete list of what can go wrong over HTTP; a kind is never renamed, because
clients branch on it. Source: RFC 9457, Problem Details for HTTP APIs (2023).
"""

from collections.abc import Mapping

from starlette.exceptions import HTTPException

from ..core.errors import ExcitationError, LogError, OptionError, RobotError, SolverError, VeritorqueError
from .json_text import plain
from .store.errors import DamagedError

MEDIA_TYPE = "application/problem+json"
URN = "urn:veritorque:problem:"

# kind: (status, title)
KINDS: dict[str, tuple[int, str]] = {
    "bad-request": (400, "The request cannot be read"),
    "not-json": (400, "The body is not valid JSON"),
    "no-key": (401, "Authentication failed"),
    "no-scope": (403, "The key lacks the required scope"),
    "other-site": (403, "Cross-site request refused"),
    "not-found": (404, "Resource not found"),
    "method-not-allowed": (405, "Method not allowed"),
    "not-acceptable": (406, "Not acceptable"),
    "job-unfinished": (409, "The job has no results yet"),
    "job-failed": (409, "The job has no results because it failed"),
    "job-dismissed": (409, "The job has no results because it was dismissed"),
    "in-use": (409, "The resource is in use"),
    "built-in": (409, "Built-in robots cannot be deleted"),
    "digest": (400, "The body does not match its digest"),
    "too-slow": (408, "Request timeout"),
    "too-large": (413, "The body is too large"),
    "unsupported-media-type": (415, "Unsupported media type"),
    "wrong-host": (421, "Unknown host"),
    "request": (422, "The request is invalid"),
    "key-reused": (422, "Idempotency-Key reused for a different request"),
    "unknown-reference": (422, "The request refers to a resource that does not exist"),
    "robot": (422, "Invalid robot description"),
    "log": (422, "Invalid log"),
    "option": (422, "Invalid options"),
    "excitation": (422, "Insufficient excitation"),
    "solver": (422, "The solver found no optimum"),
    "job-timeout": (422, "The computation exceeded the time limit"),
    "job-memory": (422, "The computation exceeded the memory limit"),
    "too-many": (429, "Too many requests"),
    "head-too-large": (431, "Request header fields too large"),
    "quota": (429, "Quota exceeded"),
    "internal": (500, "Internal server error"),
    "damaged": (500, "Stored data are damaged"),
    "computation-stopped": (500, "The computation stopped unexpectedly"),
    "not-ready": (503, "The service is starting"),
    "stopping": (503, "The service is stopping"),
    "unavailable": (503, "The database is unavailable"),
    "disk-full": (507, "Insufficient storage"),
}

_KIND_OF_ERROR: dict[type[VeritorqueError], str] = {
    RobotError: "robot",
    LogError: "log",
    OptionError: "option",
    ExcitationError: "excitation",
    SolverError: "solver",
}


class Problem(HTTPException):
    """Describe an error to a client: cause, evidence and remedy.

    Parameters
    ----------
    kind
        One of `KINDS`; it decides type, title and status.
    cause
        One sentence: what is wrong.
    evidence
        The numbers, names and JSON pointers that show it.
    remedy
        One sentence: what to change.
    headers
        Further response headers.

    Examples
    --------
    >>> Problem("not-found", "there is no log abc").document()["type"]
    'urn:veritorque:problem:not-found'
    """

    def __init__(
        self,
        kind: str,
        cause: str,
        *,
        evidence: Mapping[str, object] | None = None,
        remedy: str = "",
        headers: Mapping[str, str] | None = None,
    ) -> None:
        status, self.title = KINDS[kind]
        super().__init__(status, detail=cause, headers=dict(headers or {}))
        self.kind = kind
        self.evidence = dict(evidence or {})
        self.remedy = remedy

    def document(self) -> dict[str, object]:
        """Serialise the problem."""
        return {
            "type": URN + self.kind,
            "title": self.title,
            "status": self.status_code,
            "detail": f"{self.detail}; {self.remedy}" if self.remedy else self.detail,
            "cause": self.detail,
            "evidence": plain(self.evidence),
            "remedy": self.remedy,
        }

    @classmethod
    def from_document(cls, document: Mapping[str, object]) -> "Problem":
        """Read a serialised problem.

        Examples
        --------
        >>> Problem.from_document(Problem("not-found", "there is no log abc").document()).kind
        'not-found'
        """
        kind = str(document["type"]).removeprefix(URN)
        evidence = document["evidence"]
        return cls(
            kind if kind in KINDS else "internal",
            str(document["cause"]),
            evidence=evidence if isinstance(evidence, Mapping) else {},
            remedy=str(document["remedy"]),
        )


def problem_of(error: VeritorqueError) -> Problem:
    """Convert an error of the core into a problem.

    Examples
    --------
    >>> problem_of(LogError("the log is empty", evidence={"rows": 0}, remedy="upload another")).status_code
    422
    """
    kind = next((kind for known, kind in _KIND_OF_ERROR.items() if isinstance(error, known)), "request")
    return Problem(kind, error.cause, evidence=error.evidence, remedy=error.remedy)


def problem_of_damage(error: DamagedError) -> Problem:
    """Describe damaged stored data; the client is not at fault."""
    return Problem(
        "damaged",
        "the stored bytes do not match their hash",
        evidence={"sha256": error.sha256, "seen": error.evidence},
        remedy="delete the resource and upload it again, or have the operator run: veritorque doctor",
    )
