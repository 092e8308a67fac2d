"""Serve logs: uploaded as recorded, read once to say what is in them, kept as the bytes they came in."""

from dataclasses import replace
from typing import Annotated, cast

import anyio
from fastapi import Query, Request, Response
from fastapi.responses import JSONResponse

from ..http.body.json_body import check, media_type_of, parse_json, parse_object, require_media_type
from ..http.body.uploads import (
    LOG_MEDIA_TYPES,
    LONGEST_TEXT_FILE,
    MULTIPART,
    claimed_type,
    file_of,
    open_form,
    receive_body,
    receive_part,
    refuse_unknown_parts,
    text_of,
)
from ..http.immutable_response import UNCHANGED, IfNoneMatch
from ..http.negotiation import matches
from ..http.openapi import body, file_part, problems, reference, text_part
from ..http.pagination import CursorOf, Limit, before, following
from ..http.routing import chapter
from ..problems import Problem
from ..schemas.examples import CSV_LOG, MAPPING, READING
from ..schemas.logs import LogList, LogReading, LogSummary, LogTraces
from ..services.decimated_traces import SelectionOf
from ..services.serialisers import log_document
from ..services.services import ContextOf, RequestContext
from ..store.blobs.incoming import Incoming
from ..store.records import LogRecord
from ..version import VERSION

ROUTER = chapter("/v1/logs", tag="logs")
FORM_SCHEMA = {
    "type": "object",
    "required": ["file"],
    "properties": {
        "file": file_part(
            "CSV, Parquet, NPZ, MATLAB, HDF5, MCAP or a ROS bag (1 or 2); columns time, q_1.., tau_1.. "
            "unless a mapping names others"
        ),
        "mapping": text_part(
            f"JSON, as text or as a file: channel and unit of each column, e.g. {MAPPING}", default="{}"
        ),
    },
    "additionalProperties": False,
}
RAW_CONTENT = {
    kind: {"schema": {"type": "string", "format": "binary"}} for kind in LOG_MEDIA_TYPES if kind != "text/csv"
}


@ROUTER.post(
    "",
    status_code=201,
    response_model=LogSummary,
    summary="Upload a log",
    responses=problems(400, 413, 415, 422),
    openapi_extra=body(
        {MULTIPART: {"schema": FORM_SCHEMA}, "text/csv": {"schema": {"type": "string"}, "example": CSV_LOG}}
        | RAW_CONTENT
    ),
)
async def create_log(
    request: Request,
    context: ContextOf,
    name: Annotated[str | None, Query(max_length=200)] = None,
    mapping: Annotated[str | None, Query(max_length=60_000, description=f"JSON, e.g. {MAPPING}")] = None,
) -> Response:
    """Upload a log, as the body itself or as a form.

    Invalid data are refused; defects of usable data are listed.
    """
    media_type = require_media_type(request, (MULTIPART, *LOG_MEDIA_TYPES))
    with context.store.blobs.receive() as incoming:
        if media_type == MULTIPART:
            log = await _from_form(request, context, incoming, name=name, mapping=mapping)
        else:
            await receive_body(request, incoming)
            log = await _add(
                context, incoming, name=name or "log", mapping=mapping, kind=media_type_of(request)
            )
    return JSONResponse(log_document(log), 201, headers={"Location": f"/v1/logs/{log.id}"})


@ROUTER.get("", response_model=LogList, summary="List logs", responses=problems(422))
def list_logs(context: ContextOf, limit: Limit = 100, cursor: CursorOf = None) -> Response:
    """List logs, newest first."""
    logs = context.store.logs.page(limit=limit, before=before(cursor))
    return JSONResponse({"logs": [log_document(log) for log in logs], "next": following(logs, limit)})


@ROUTER.get("/{log_id}", response_model=LogSummary, summary="Read a log", responses=problems(404))
def read_log(context: ContextOf, log_id: str) -> Response:
    """Read the summary of a log with its defects."""
    return JSONResponse(log_document(context.catalogue.log(log_id)))


@ROUTER.post(
    "/{log_id}/readings",
    status_code=201,
    response_model=LogSummary,
    summary="Read a log with another mapping",
    responses=problems(404, 413, 415, 422),
    openapi_extra=body({"application/json": {"schema": reference(LogReading), "example": READING}}),
)
async def read_again(request: Request, context: ContextOf, log_id: str) -> Response:
    """Read the bytes of a log with another mapping, as another log. The first one stays as it is."""
    require_media_type(request, ("application/json",))
    asked = check(LogReading, parse_json(await request.body()))
    log = await anyio.to_thread.run_sync(context.catalogue.log, log_id)
    again = await anyio.to_thread.run_sync(
        lambda: context.catalogue.read_again(log, dict(asked.mapping) or None), limiter=context.readers
    )
    return JSONResponse(log_document(again), 201, headers={"Location": f"/v1/logs/{again.id}"})


@ROUTER.get(
    "/{log_id}/traces",
    response_model=LogTraces,
    summary="Read traces of a log",
    responses=problems(404, 422) | UNCHANGED,
)
async def read_traces(
    context: ContextOf, log_id: str, selection: SelectionOf, if_none_match: IfNoneMatch = None
) -> Response:
    """Read the channels of a log, min/max decimated; `from` and `to` select a range."""
    log = await anyio.to_thread.run_sync(context.catalogue.log, log_id)
    selection = replace(selection, channels=_requested(log, selection.channels))
    asked = (selection.points, "-".join(selection.channels), selection.begin, selection.end)
    etag = f'"{log.id}-{"-".join(map(str, asked))}-{VERSION}"'
    headers = {"ETag": etag, "Cache-Control": "private, no-cache"}
    if matches(if_none_match, etag):
        return Response(status_code=304, headers=headers)
    document = await anyio.to_thread.run_sync(
        lambda: context.catalogue.trace_log(log, selection), limiter=context.readers
    )
    return Response(document, media_type="application/json", headers=headers)


@ROUTER.delete("/{log_id}", status_code=204, summary="Delete a log", responses=problems(404, 409))
def delete_log(context: ContextOf, log_id: str) -> None:
    """Delete a log that no unfinished job needs."""
    log = context.catalogue.log(log_id)
    context.queue.refuse_if_needed(log=log.id)
    context.store.logs.remove(log.id)


def _requested(log: LogRecord, names: tuple[str, ...]) -> tuple[str, ...]:
    """Give the channels that are asked for, in the order of the log; all where none is named."""
    known = [str(channel) for channel in cast("list[object]", log.summary["channels"])]
    asked = names or known
    unknown = [name for name in asked if name not in known]
    if unknown:
        raise Problem(
            "request",
            f"the log has no channel {unknown[0]!r}",
            evidence={"parameter": "channels", "unknown": unknown, "known": known},
            remedy="name channels of the log, or leave the parameter out for all of them",
        )
    return tuple(channel for channel in known if channel in asked)


async def _from_form(
    request: Request, context: RequestContext, incoming: Incoming, *, name: str | None, mapping: str | None
) -> LogRecord:
    async with open_form(request, longest_text=LONGEST_TEXT_FILE) as form:
        refuse_unknown_parts(form, ("file", "mapping"))
        part = file_of(form, "file")
        name = name or part.filename or "log"
        given = await text_of(form, "mapping")
        await receive_part(part, incoming)
        return await _add(context, incoming, name=name, mapping=given or mapping, kind=claimed_type(part))


async def _add(
    context: RequestContext, incoming: Incoming, *, name: str, mapping: bytes | str | None, kind: str | None
) -> LogRecord:
    columns = parse_object(mapping, what="the mapping")
    return await anyio.to_thread.run_sync(
        lambda: context.catalogue.add_log(incoming, name=name, mapping=columns, media_type=kind),
        limiter=context.readers,
    )
