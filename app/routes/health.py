"""Serve what an operator asks: does it live, is it ready, how is it doing, which version is it."""

import platform
from importlib.metadata import version

from fastapi import Request, Response
from fastapi.responses import JSONResponse

from ..auth.callers import require_scope
from ..http.openapi import problems
from ..http.routing import chapter
from ..services.services import CallerOf, ServicesOf
from ..version import VERSION

ROUTER = chapter(tag="service")
PACKAGES = ("clarabel", "cvxpy-base", "fastapi", "numba", "numpy", "pyarrow", "scipy", "sqlalchemy")


@ROUTER.get("/healthz", response_model=dict[str, str], summary="Liveness")
async def healthz() -> Response:
    """Answer as long as the service answers at all."""
    return JSONResponse({"status": "alive"})


@ROUTER.get("/readyz", response_model=dict[str, str], summary="Readiness", responses=problems(503))
def readyz(services: ServicesOf) -> Response:
    """Answer while the database takes writes, a worker has the solver loaded, and the disk has room."""
    services.readiness.require()
    return JSONResponse({"status": "ready"})


@ROUTER.get(
    "/metrics",
    response_class=Response,
    summary="Metrics",
    responses=problems(401, 403)
    | {200: {"content": {"text/plain": {"schema": {"type": "string"}}}, "description": "For Prometheus"}},
)
def metrics(services: ServicesOf, caller: CallerOf, request: Request) -> Response:
    """Give counts and times in Prometheus' form; where keys are needed, with one of scope admin."""
    require_scope(caller, "admin")
    content, media_type = services.metrics.written(request.headers.get("accept", ""))
    return Response(content, media_type=media_type)


@ROUTER.get("/version", response_model=dict[str, str | dict[str, str]], summary="Versions")
def versions() -> Response:
    """Name the versions of the service and of what its numbers depend on."""
    packages = {name: version(name) for name in PACKAGES}
    return JSONResponse(
        {"version": VERSION, "api": "v1", "python": platform.python_version(), "packages": packages}
    )
