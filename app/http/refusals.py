"""Refuse what no application is asked to answer: what is no request, or does not become one."""

from starlette.responses import Response

from ..problems import Problem
from .exception_handlers import HEADERS, problem_response

HEAD_TICKS = 17
"""Ticks for which a head may stay unfinished: 8.5 s."""
BODY_TICKS = 17
"""Ticks in which a body has to grow by `BODY_BYTES`."""
BODY_BYTES = 17 * 512
"""1 KiB/s: no link in use is slower."""
LARGEST_HEAD = 128 * 1024


def refusal(problem: Problem) -> Response:
    """Answer with a problem where nothing else stands before the answer."""
    response = problem_response(problem)
    response.raw_headers.extend(HEADERS)
    return response


def not_http(reason: str) -> Problem:
    """Refuse what is no HTTP."""
    return Problem(
        "bad-request",
        "the request is not HTTP/1.1 that can be read",
        evidence={"reason": reason},
        remedy="send it as RFC 9112 says; most clients do",
    )


def stopping() -> Problem:
    """Refuse what is not done before the service has to stop."""
    return Problem(
        "stopping",
        "the service stops before the request is done",
        remedy="send the request again in a few seconds; the same bytes sent twice are the same log",
        headers={"Retry-After": "5"},
    )


def too_slow(cause: str) -> Problem:
    """Refuse what does not come on."""
    return Problem(
        "too-slow",
        cause,
        evidence={"head_s": HEAD_TICKS / 2, "body_bytes_per_s": 2 * BODY_BYTES // BODY_TICKS},
        remedy="send the request without long pauses",
    )


def head_too_large() -> Problem:
    """Refuse a head without end."""
    return Problem(
        "head-too-large",
        f"the head of the request is larger than {LARGEST_HEAD} bytes",
        evidence={"limit_bytes": LARGEST_HEAD},
        remedy="send a shorter address and fewer headers; a long mapping fits into a form",
    )


def trailers_too_large() -> Problem:
    """Refuse trailers, or what else goes with a body, without end."""
    return Problem(
        "head-too-large",
        f"what goes with the body is larger than {LARGEST_HEAD} bytes",
        evidence={"limit_bytes": LARGEST_HEAD},
        remedy="send fewer trailers, or none: they are not read",
    )


def too_large(limit: int) -> Problem:
    """Refuse a body, or a file in it, of more bytes than are taken."""
    return Problem(
        "too-large",
        f"the body, or a file in it, is larger than {limit} bytes",
        evidence={"limit_bytes": limit},
        remedy="send less, as Parquet perhaps, or let the operator raise VERITORQUE_MAX_UPLOAD_BYTES",
        headers={"Connection": "close"},
    )
