"""Serve a whole analysis in one request: robot and log in, result out."""

from typing import Annotated

import anyio
from fastapi import Header, Request, Response
from fastapi.responses import JSONResponse
from starlette.datastructures import FormData, UploadFile

from ..http.body.json_body import parse_json, parse_object, require_media_type
from ..http.body.uploads import (
    MULTIPART,
    claimed_type,
    files_of,
    open_form,
    receive_part,
    refuse_unknown_parts,
    text_of,
)
from ..http.exception_handlers import problem_response
from ..http.negotiation import LONGEST_WAIT_S, wait_seconds
from ..http.openapi import body, file_part, problems, text_part
from ..http.routing import chapter
from ..jobs.queue import Submission
from ..kinds.identify import Identify
from ..problems import Problem
from ..schemas.examples import MAPPING
from ..schemas.jobs import Job
from ..schemas.results import ResultDocument
from ..services.job_feed import wait_for
from ..services.serialisers import job_document
from ..services.services import ContextOf, RequestContext
from ..store.records import JobRecord, LogRecord, RobotRecord

ROUTER = chapter("/v1/identify", tag="identify")
PARTS = ("robot", "log", "mapping", "options")
LONGEST_ROBOT = 5 * 1024**2
FORM_SCHEMA = {
    "type": "object",
    "required": ["robot", "log"],
    "properties": {
        "robot": text_part(
            "the id of a robot, a description (JSON) or a URDF (XML); as text or as a file",
            default="yumi-left",
        ),
        "log": {
            "type": "array",
            "items": file_part("a log"),
            "minItems": 1,
            "description": "one or more logs",
        },
        "mapping": text_part(
            f"JSON, as text or as a file, the same for all logs, e.g. {MAPPING}", default="{}"
        ),
        "options": text_part("JSON, as text or as a file: options of the job", default="{}"),
    },
    "additionalProperties": False,
}


@ROUTER.post(
    "",
    response_model=ResultDocument,
    summary="Identify a robot from a log in one request",
    responses=problems(400, 413, 415, 422)
    | {202: {"model": Job, "description": "The job takes longer than the waiting time; follow it"}},
    openapi_extra=body({MULTIPART: {"schema": FORM_SCHEMA}}),
)
async def identify(
    request: Request,
    context: ContextOf,
    prefer: Annotated[
        str | None, Header(max_length=200, description="wait=N: wait up to N seconds; default 60")
    ] = None,
) -> Response:
    """Create the robot, upload the logs, run the job, and answer its result or its problem."""
    require_media_type(request, (MULTIPART,))
    async with open_form(request, longest_text=LONGEST_ROBOT) as form:
        refuse_unknown_parts(form, PARTS)
        options = parse_object(await text_of(form, "options"), what="options") or {}
        mapping = parse_object(await text_of(form, "mapping"), what="the mapping")
        files = files_of(form, "log")
        robot = await _robot(context, form)
        logs = tuple([await _log(context, part, mapping) for part in files])
    ids = tuple(log.id for log in logs)
    submission = Submission(Identify.name, robot.id, ids, options, trace=request.state.trace)
    job = await context.batcher.take(context.caller.tenant, context.queue.begin_to_submit, submission)
    seconds = wait_seconds(prefer)
    job = await wait_for(context.feed, job, LONGEST_WAIT_S if seconds is None else seconds)
    return await anyio.to_thread.run_sync(_answer, context, job)


async def _robot(context: RequestContext, form: FormData) -> RobotRecord:
    given = form.getlist("robot")
    if len(given) != 1:
        raise Problem(
            "request",
            "the form holds no part named robot" if not given else "the form holds several robots",
            evidence={"parts": sorted(set(form))},
            remedy="send one: an id, a description in JSON, or a URDF",
        )
    part = given[0]
    content = await part.read(LONGEST_ROBOT + 1) if isinstance(part, UploadFile) else part.encode()
    return await anyio.to_thread.run_sync(_find_or_create, context, content.strip())


def _find_or_create(context: RequestContext, content: bytes) -> RobotRecord:
    if content.startswith(b"{"):
        return context.catalogue.add_description(parse_json(content, what="the robot"))
    if content.startswith((b"<", b"\xef\xbb\xbf")):
        return context.catalogue.add_urdf(content)
    return context.catalogue.robot(content.decode(errors="replace")[:100], named_in_body=True)


async def _log(context: RequestContext, part: UploadFile, mapping: dict[str, object] | None) -> LogRecord:
    with context.store.blobs.receive() as incoming:
        await receive_part(part, incoming)
        return await anyio.to_thread.run_sync(
            lambda: context.catalogue.add_log(
                incoming, name=part.filename or "log", mapping=mapping, media_type=claimed_type(part)
            ),
            limiter=context.readers,
        )


def _answer(context: RequestContext, job: JobRecord) -> Response:
    path = f"/v1/jobs/{job.id}"
    if job.result_sha256 is not None:
        result = context.store.blobs.read(job.result_sha256)
        return Response(
            result, media_type="application/json", headers={"Content-Location": f"{path}/results"}
        )
    if job.state == "dismissed":
        return problem_response(Problem("job-dismissed", "the job was dismissed", remedy="ask for it again"))
    if job.problem is not None:
        return problem_response(Problem.from_document(job.problem))
    return JSONResponse(job_document(job), 202, headers={"Location": path, "Retry-After": "1"})
