"""Put the service together: settings in, one ASGI application out.

Nothing is opened before the application starts, so that the contract can be printed without a database or a
solver.
"""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

import anyio
from fastapi import FastAPI

from .http import exception_handlers, openapi
from .http.body.content_digest import ContentDigest
from .http.disk_reserve import DiskReserve
from .http.host_guard import HostGuard
from .http.middleware import BodyLimit, HeadAsGet, SafeHeaders
from .http.request_log import RequestLog
from .jobs.executors.executor import Executor
from .jobs.supervisor import Supervisor
from .routes import events, health, identify, jobs, logs, pages, robots, traces
from .services.metrics import Metrics
from .services.services import Services
from .settings import Settings
from .version import VERSION

TAGS = [
    {"name": "robots", "description": "Robot descriptions: joints, geometry, gravity, prior."},
    {"name": "logs", "description": "Measured position, torque or current over time."},
    {"name": "jobs", "description": "Computations and their results."},
    {"name": "identify", "description": "Identification in one request."},
    {"name": "service", "description": "For operators."},
]


def create_app(
    settings: Settings | None = None,
    *,
    executor: Executor | None = None,
    supervisor: Supervisor | None = None,
    metrics: Metrics | None = None,
) -> FastAPI:
    """Make the application.

    Parameters
    ----------
    settings
        Read from the environment if None.
    executor
        What computes; a process per computation if None.
    supervisor
        Keeps the process alive that sees to the computing; None to see to it within this one.
    metrics
        Where requests and jobs are counted; new ones if None.
    """
    chosen, counted = settings or Settings(), metrics or Metrics()

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        opened = await anyio.to_thread.run_sync(Services.open, chosen, counted, executor, supervisor)
        app.state.services = opened
        try:
            yield
        finally:
            await opened.feed.close()
            await opened.batcher.close()
            await anyio.to_thread.run_sync(opened.close)

    app = FastAPI(
        title="Veritorque",
        version=VERSION,
        summary="Convex semidefinite robot dynamic identification",
        license_info={"name": "Apache-2.0", "identifier": "Apache-2.0"},
        openapi_tags=TAGS,
        docs_url=None,
        redoc_url=None,
        lifespan=lifespan,
    )
    for chapter in (jobs, traces, events, robots, logs, identify, health, pages):
        app.router.routes.extend(chapter.ROUTER.routes)
    exception_handlers.install(app)
    app.add_middleware(ContentDigest)
    disk = DiskReserve(chosen.data_dir, chosen.disk_reserve_bytes)
    app.add_middleware(BodyLimit, upload_limit=chosen.max_upload_bytes, disk=disk)
    app.add_middleware(HeadAsGet)
    app.add_middleware(HostGuard, hosts=(chosen.host, *chosen.hosts))
    app.add_middleware(SafeHeaders)
    app.add_middleware(RequestLog, metrics=counted)

    def contract() -> dict[str, Any]:
        if app.openapi_schema is None:
            app.openapi_schema = openapi.document(app)
        return app.openapi_schema

    app.openapi = contract  # type: ignore[method-assign]  # the way FastAPI documents
    return app
