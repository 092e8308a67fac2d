"""Say every failure as one RFC 9457 problem document: stable type, status, cause, evidence and remedy.

The table of kinds is the complete list of what can go wrong over HTTP; a kind is never renamed, because
clients branch on it. Source: RFC 9457, Problem Details for HTTP APIs (2023).
"""

from collections.abc import Mapping

from starlette.exceptions import HTTPException

from ..core.errors import ExcitationError, LogError, OptionError, RobotError, SolverError, VeritorqueError
from .json_text import plain
from .store.errors import Damaged

MEDIA_TYPE = "application/problem+json"
URN = "urn:veritorque:problem:"

# kind: (status, title)
KINDS: dict[str, tuple[int, str]] = {
    "bad-request": (400, "The request cannot be read"),
    "not-json": (400, "The document is not JSON that can be used"),
    "no-key": (401, "The request carries no key that is known"),
    "no-scope": (403, "The key does not permit this"),
    "other-site": (403, "The request comes from a page of another site"),
    "not-found": (404, "There is no such resource"),
    "method-not-allowed": (405, "The resource does not take this method"),
    "not-acceptable": (406, "The resource does not come in this form"),
    "job-unfinished": (409, "The job has no results yet"),
    "job-failed": (409, "The job has no results because it failed"),
    "job-dismissed": (409, "The job has no results because it was dismissed"),
    "in-use": (409, "The resource is still needed"),
    "built-in": (409, "The robot is built in"),
    "digest": (400, "The body is not the one that was announced"),
    "too-slow": (408, "The request came too slowly"),
    "too-large": (413, "The body is larger than the service takes"),
    "unsupported-media-type": (415, "The body comes in a form that is not known"),
    "wrong-host": (421, "The request is meant for another host"),
    "request": (422, "The request does not follow the contract"),
    "key-reused": (422, "The Idempotency-Key stands for another request"),
    "unknown-reference": (422, "The request names something that does not exist"),
    "robot": (422, "The description of the robot cannot be used"),
    "log": (422, "The log cannot be used"),
    "option": (422, "The options cannot be used"),
    "excitation": (422, "The motion cannot tell what was asked of it"),
    "solver": (422, "The optimiser stopped without an optimum"),
    "job-timeout": (422, "The computation took too long"),
    "job-memory": (422, "The computation needs too much memory"),
    "too-many": (429, "Too many requests"),
    "head-too-large": (431, "The head of the request is too large"),
    "quota": (429, "The key's share is used up"),
    "internal": (500, "The service made a mistake"),
    "damaged": (500, "What was kept is damaged"),
    "computation-stopped": (500, "The computation stopped unexpectedly"),
    "not-ready": (503, "The service is starting"),
    "stopping": (503, "The service is stopping"),
    "unavailable": (503, "The database does not answer"),
    "disk-full": (507, "The disk is nearly full"),
}

_KIND_OF_ERROR: dict[type[VeritorqueError], str] = {
    RobotError: "robot",
    LogError: "log",
    OptionError: "option",
    ExcitationError: "excitation",
    SolverError: "solver",
}


class Problem(HTTPException):
    """Tell a client what went wrong, what was seen, and what to do about it.

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
        """Write the problem as the document that is sent."""
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
        """Read a problem back that was written as a document.

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
    """Turn an error of the science into a problem.

    Examples
    --------
    >>> problem_of(LogError("the log is empty", evidence={"rows": 0}, remedy="upload another")).status_code
    422
    """
    kind = next((kind for known, kind in _KIND_OF_ERROR.items() if isinstance(error, known)), "request")
    return Problem(kind, error.cause, evidence=error.evidence, remedy=error.remedy)


def problem_of_damage(error: Damaged) -> Problem:
    """Say that bytes are not what they were, which is never a client's fault."""
    return Problem(
        "damaged",
        "the disk gave back other bytes than were kept",
        evidence={"sha256": error.sha256, "seen": error.evidence},
        remedy="delete what needs them and send it again, or let the operator run: veritorque doctor",
    )
