"""Serve what an operator asks: does it live, is it ready, which version is it."""

import platform
from importlib.metadata import version

from fastapi import Response
from fastapi.responses import JSONResponse

from app.openapi import problems
from app.problems import Problem
from app.routing import chapter
from app.services import ServicesOf
from app.version import VERSION

ROUTER = chapter(tag="service")
PACKAGES = ("clarabel", "cvxpy-base", "fastapi", "numba", "numpy", "pyarrow", "scipy", "sqlalchemy")


@ROUTER.get("/healthz", response_model=dict[str, str], summary="Does it live?")
async def healthz() -> Response:
    """Answer as long as the service answers at all."""
    return JSONResponse({"status": "alive"})


@ROUTER.get("/readyz", response_model=dict[str, str], summary="Is it ready?", responses=problems(503))
async def readyz(services: ServicesOf) -> Response:
    """Answer once the solver is loaded; jobs are accepted before and wait for it."""
    if not services.ready:
        raise Problem(
            "not-ready",
            "the solver is being loaded; at the very first start it is compiled",
            remedy="jobs may be sent and will wait; ask again in a few seconds",
            headers={"Retry-After": "2"},
        )
    return JSONResponse({"status": "ready"})


@ROUTER.get("/version", response_model=dict[str, str | dict[str, str]], summary="Which version is it?")
def versions() -> Response:
    """Name the versions of the service and of what its numbers depend on."""
    packages = {name: version(name) for name in PACKAGES}
    return JSONResponse(
        {"version": VERSION, "api": "v1", "python": platform.python_version(), "packages": packages}
    )
