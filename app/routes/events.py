"""Serve the progress of a job as it happens, as server-sent events.

An event's id is the version of the job, which the database keeps: a client that reconnects, even
to a restarted service, receives what changed since. Source: https://html.spec.whatwg.org/multipage/server-sent-events.html
"""

from collections.abc import AsyncIterator
from typing import Annotated

from fastapi import Header, Response
from fastapi.responses import StreamingResponse

from ..http.openapi import problems, reference
from ..http.routing import chapter
from ..json_text import json_bytes
from ..schemas.jobs import Job
from ..services.job_feed import JobFeed, no_such_job
from ..services.serialisers import job_document
from ..services.services import ContextOf
from ..store.errors import UnavailableError
from ..store.records import JobRecord

ROUTER = chapter("/v1/jobs", tag="jobs")
MEDIA_TYPE = "text/event-stream"
HEARTBEAT_S = 15.0
"""Silence after which a comment says that the connection lives."""
COME_BACK_MS = 2000
EVENT = {
    "type": "object",
    "required": ["data"],
    "properties": {
        "id": {"type": "string", "description": "version of the job"},
        "event": {"enum": ["progress", "end"]},
        "data": {"type": "string", "contentMediaType": "application/json", "contentSchema": reference(Job)},
        "retry": {"type": "integer"},
    },
}
"""An event as a client parses it. `itemSchema` is of OpenAPI 3.2; `schema` describes whole answers only."""
HEADERS = {"Cache-Control": "no-store", "X-Accel-Buffering": "no"}


@ROUTER.get(
    "/{job_id}/events",
    response_class=Response,
    summary="Stream the progress of a job",
    responses=problems(404)
    | {
        200: {
            "content": {MEDIA_TYPE: {"itemSchema": EVENT}},
            "description": "An event `progress` at every change and `end` at the last; each holds the job",
        },
        204: {"description": "The job has ended and there are no further events"},
    },
)
async def follow_job(
    context: ContextOf,
    job_id: str,
    last_event_id: Annotated[
        str | None, Header(max_length=200, description="id of the last received event")
    ] = None,
) -> Response:
    """Follow a job until it ends. The first event tells how far it is, unless Last-Event-ID is up to date."""
    job = await context.feed.job((context.caller.tenant, job_id))
    if job is None:
        raise no_such_job(job_id)
    known = _version(last_event_id)
    if job.finished and job.version == known:
        return Response(status_code=204)  # a browser does not reconnect after that
    return StreamingResponse(_events(context.feed, job, known), headers=HEADERS, media_type=MEDIA_TYPE)


async def _events(feed: JobFeed, job: JobRecord, known: int | None) -> AsyncIterator[bytes]:
    yield b"retry: %d\n\n" % COME_BACK_MS
    while True:
        if job.version != known:
            known = job.version
            yield _event(job)
        if job.finished:
            return
        try:
            now = await feed.change((job.tenant, job.id), known=known, seconds=HEARTBEAT_S)
        except UnavailableError:
            return  # the client reconnects, and gets a problem document if that lasts
        if now is None or (feed.ending and now.version == known):
            return
        if now.version == known:
            yield b": alive\n\n"
        job = now


def _event(job: JobRecord) -> bytes:
    name = b"end" if job.finished else b"progress"
    return b"id: %d\nevent: %s\ndata: %s\n\n" % (job.version, name, json_bytes(job_document(job)))


def _version(last_event_id: str | None) -> int | None:
    """Read the id of an event; what is no id of ours is as if there were none."""
    known = last_event_id or ""
    return int(known) if known.isascii() and known.isdigit() and len(known) < 20 else None
