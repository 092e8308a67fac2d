"""Turn all that can go wrong into a problem document, whether core, the framework or a bug raised it."""

import errno
import logging
import secrets

from fastapi import FastAPI
from fastapi.exceptions import RequestValidationError
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect, Request
from starlette.responses import HTMLResponse, Response
from starlette.routing import Match

from ...core.errors import VeritorqueError
from ..json_text import json_bytes
from ..pages.files import STRICT, shell
from ..problems import KINDS, MEDIA_TYPE, Problem, problem_of, problem_of_damage
from ..store.errors import DamagedError, KeyReusedError, OverQuotaError, UnavailableError
from .body.json_body import invalid
from .negotiation import preferred

HTML = "text/html"
LOGGER = logging.getLogger(__name__)
HEADERS = (
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"no-referrer"),
    (b"cross-origin-resource-policy", b"same-origin"),
    (b"cross-origin-opener-policy", b"same-origin"),
)
"""Headers of every response; the middleware adds them, unless the response bypasses it."""
METHODS = ("GET", "POST", "PUT", "PATCH", "DELETE", "OPTIONS")
DISK_FULL = (errno.ENOSPC, errno.EDQUOT)
QUOTA_RETRY_S = "5"
_KIND_OF_STATUS = {400: "bad-request", 404: "not-found", 405: "method-not-allowed", 413: "too-large"}


def problem_response(problem: Problem) -> Response:
    """Answer with a problem document."""
    return Response(
        json_bytes(problem.document()),
        status_code=problem.status_code,
        headers=dict(problem.headers or {}),
        media_type=MEDIA_TYPE,
    )


def install(app: FastAPI) -> None:
    """Let the app answer every failure with a problem document."""
    app.add_exception_handler(HTTPException, _on_http)
    app.add_exception_handler(RequestValidationError, _on_validation)
    app.add_exception_handler(VeritorqueError, _on_core_error)
    app.add_exception_handler(UnavailableError, _on_unavailable)
    app.add_exception_handler(OverQuotaError, _on_quota)
    app.add_exception_handler(KeyReusedError, _on_key)
    app.add_exception_handler(DamagedError, _on_damage)
    app.add_exception_handler(ClientDisconnect, _on_loss)
    app.add_exception_handler(OSError, _on_system)
    app.add_exception_handler(Exception, _on_mistake)


async def _on_http(request: Request, error: Exception) -> Response:
    if isinstance(error, HTTPException) and error.status_code == KINDS["not-found"][0] and _reads(request):
        return HTMLResponse(shell("not_found"), error.status_code, headers=STRICT | {"Vary": "Accept"})
    if isinstance(error, Problem):
        return problem_response(error)
    status = error.status_code if isinstance(error, HTTPException) else 500
    if status == KINDS["method-not-allowed"][0]:
        return problem_response(_wrong_method(request))
    kind, path = _KIND_OF_STATUS.get(status, "bad-request"), request.url.path
    cause, remedy = str(getattr(error, "detail", "")), "send the request as /docs shows it"
    if kind == "not-found":
        cause, remedy = f"there is nothing at {path}", "/docs lists all resources"
    return problem_response(Problem(kind, cause, evidence={"path": path}, remedy=remedy))


async def _on_loss(request: Request, error: Exception) -> Response:
    """Send nothing: the client is gone, or was refused meanwhile."""
    del request, error
    return problem_response(Problem("bad-request", "the request ended early", remedy="send it again"))


def _reads(request: Request) -> bool:
    """Return whether a person reads the answer: browsers like a page best, programs a problem document."""
    offers = (MEDIA_TYPE, "application/json", HTML)
    return request.method in ("GET", "HEAD") and preferred(request.headers.get("accept"), offers) == HTML


async def _on_validation(_request: Request, error: Exception) -> Response:
    complaints = list(error.errors()) if isinstance(error, RequestValidationError) else []
    return problem_response(invalid(complaints))


async def _on_core_error(_request: Request, error: Exception) -> Response:
    return problem_response(problem_of(error) if isinstance(error, VeritorqueError) else _internal_error(""))


async def _on_unavailable(_request: Request, error: Exception) -> Response:
    LOGGER.error("the database does not answer: %s", error)
    return problem_response(_unavailable(str(error)))


async def _on_quota(_request: Request, error: Exception) -> Response:
    if not isinstance(error, OverQuotaError):
        raise error
    problem = Problem(
        "quota",
        f"no more than {error.most} {error.what} are kept for one tenant",
        evidence={error.what: error.most},
        remedy="wait for jobs to end, delete logs and jobs that are not needed, or let the operator raise "
        + error.setting,
        headers={"Retry-After": QUOTA_RETRY_S},
    )
    return problem_response(problem)


async def _on_key(_request: Request, error: Exception) -> Response:
    if not isinstance(error, KeyReusedError):
        raise error
    problem = Problem(
        "key-reused",
        f"the Idempotency-Key {error.key} came with another request before",
        evidence={"key": error.key},
        remedy="send a new key with a new request, and the same key only with the same body",
    )
    return problem_response(problem)


async def _on_damage(_request: Request, error: Exception) -> Response:
    LOGGER.error("what was kept is damaged: %s", error)
    return problem_response(
        problem_of_damage(error) if isinstance(error, DamagedError) else _internal_error("")
    )


async def _on_system(request: Request, error: Exception) -> Response:
    if isinstance(error, OSError) and error.errno in DISK_FULL:
        LOGGER.error("the disk is full")
        return problem_response(_disk_full())
    return await _on_mistake(request, error)


async def _on_mistake(request: Request, error: Exception) -> Response:
    incident = secrets.token_hex(6)
    LOGGER.error("incident %s at %s %s", incident, request.method, request.url.path, exc_info=error)
    response = problem_response(_internal_error(incident))
    response.raw_headers.extend(HEADERS)
    return response


def _unavailable(reason: str) -> Problem:
    if "full" in reason:
        return _disk_full()
    return Problem(
        "unavailable",
        "the database does not answer",
        evidence={"reason": reason},
        remedy="send the request again in a few seconds; nothing of it was kept",
        headers={"Retry-After": "2"},
    )


def _disk_full() -> Problem:
    return Problem(
        "disk-full", "the disk is full", remedy="delete logs and jobs, or let the operator make room"
    )


def _wrong_method(request: Request) -> Problem:
    allowed = [method for method in METHODS if _takes(request, method)]
    if "GET" in allowed:
        allowed.append("HEAD")
    return Problem(
        "method-not-allowed",
        f"{request.url.path} does not take {request.method}",
        evidence={"method": request.method, "allowed": allowed},
        remedy="use one of the allowed methods",
        headers={"Allow": ", ".join(allowed)},
    )


def _takes(request: Request, method: str) -> bool:
    """Ask all routes, since each knows only its own method while several share a path."""
    scope = {**request.scope, "method": method}
    return any(route.matches(scope)[0] is Match.FULL for route in request.app.routes)


def _internal_error(incident: str) -> Problem:
    return Problem(
        "internal",
        "an unexpected error occurred in the service",
        evidence={"incident": incident},
        remedy="report it with the incident's number; the service's own log holds the details",
    )
