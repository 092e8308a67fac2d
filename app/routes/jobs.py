"""Serve jobs: asked for, followed, waited for, dismissed, and read."""

import json
from itertools import compress
from typing import Annotated, Any

from fastapi import Header, Path, Request, Response
from fastapi.responses import HTMLResponse, JSONResponse

from ..http.body.json_body import check, parse_json, require_media_type
from ..http.immutable_response import UNCHANGED, Blob, IfNoneMatch, file_response
from ..http.negotiation import matches, preferred, wait_seconds
from ..http.openapi import body, problems, reference
from ..http.pagination import CursorOf, Limit, before, following
from ..http.routing import chapter
from ..jobs.queue import Submission
from ..kinds.kind import JobKind
from ..kinds.registry import KINDS, kind_of, result_document
from ..problems import Problem
from ..schemas.jobs import Job, JobList, JobRequest
from ..services.export_files import ARTIFACTS, CONTENT, TRACES_FILE, TRACES_TYPE
from ..services.finished_jobs import RETRY_AFTER_S, find_job, report_of, result_of, traces_of
from ..services.job_feed import no_such_job, wait_for
from ..services.serialisers import PARAMETERS_FILE, job_document
from ..services.services import ContextOf
from ..store.records import JobRecord

ROUTER = chapter("/v1/jobs", tag="jobs")
RESULT_FORMS = ("application/json", "text/csv", "text/html")
EXAMPLES = {
    kind.name: {"summary": kind.words.summary, "value": kind.words.request} for kind in KINDS.values()
}


@ROUTER.post(
    "",
    status_code=202,
    response_model=Job,
    summary="Create a job",
    responses=problems(400, 413, 415, 422)
    | {200: {"model": Job, "description": "The job finished within the waiting time"}},
    openapi_extra=body({"application/json": {"schema": reference(JobRequest), "examples": EXAMPLES}}),
)
async def create_job(
    request: Request,
    context: ContextOf,
    prefer: Annotated[
        str | None, Header(max_length=200, description="wait=N: wait up to N seconds (at most 60)")
    ] = None,
    idempotency_key: Annotated[
        str | None,
        Header(
            min_length=1, max_length=200, description="key of a request that may be repeated but runs once"
        ),
    ] = None,
) -> Response:
    """Create a job, or return an existing identical one. Invalid requests are refused immediately."""
    require_media_type(request, ("application/json",))
    asked = check(JobRequest, parse_json(await request.body()))
    submission = Submission(
        kind=asked.kind,
        robot=asked.robot,
        logs=tuple(asked.logs),
        options=dict(asked.options),
        key=idempotency_key,
        trace=request.state.trace,
    )
    job = await context.batcher.take(context.caller.tenant, context.queue.begin_to_submit, submission)
    seconds = wait_seconds(prefer)
    if seconds is not None:
        job = await wait_for(context.feed, job, seconds)
    return _job_response(job, applied=seconds)


@ROUTER.get("", response_model=JobList, summary="List jobs", responses=problems(422))
def list_jobs(context: ContextOf, limit: Limit = 100, cursor: CursorOf = None) -> Response:
    """List jobs, newest first."""
    jobs = context.store.jobs.page(limit=limit, before=before(cursor))
    return JSONResponse({"jobs": [job_document(job) for job in jobs], "next": following(jobs, limit)})


@ROUTER.get("/{job_id}", response_model=Job, summary="Follow a job", responses=problems(404) | UNCHANGED)
async def read_job(context: ContextOf, job_id: str, if_none_match: IfNoneMatch = None) -> Response:
    """Read a job and its progress; with the last ETag as If-None-Match, only changes are sent."""
    job = await context.feed.job((context.caller.tenant, job_id))
    if job is None:
        raise no_such_job(job_id)
    headers = {"ETag": f'"{job.id}-{job.version}"', "Cache-Control": "no-cache"}
    if not job.finished:
        headers["Retry-After"] = RETRY_AFTER_S
    if matches(if_none_match, headers["ETag"]):
        return Response(status_code=304, headers=headers)
    return JSONResponse(job_document(job), headers=headers)


@ROUTER.get(
    "/{job_id}/results",
    response_model=result_document(),
    summary="Read the result",
    responses=problems(404, 406, 409)
    | {
        200: {
            "content": {form: {"schema": {"type": "string"}} for form in ("text/csv", "text/html")},
            "description": "The result, its base parameters as CSV, or its report",
        }
    }
    | UNCHANGED,
)
def read_results(
    context: ContextOf,
    job_id: str,
    accept: Annotated[str | None, Header(include_in_schema=False)] = None,
    if_none_match: IfNoneMatch = None,
) -> Response:
    """Read the result document; with Accept: text/csv its base parameters, with text/html its report."""
    _form(accept, RESULT_FORMS)
    job = find_job(context, job_id)
    form = _form(accept, _forms_of(kind_of(job.request.kind)))
    result = result_of(context, job)
    if form == "text/csv":
        return result.respond(if_none_match, PARAMETERS_FILE, lambda: _artifact(result, PARAMETERS_FILE))
    if form == "text/html":
        return result.respond(if_none_match, "report", lambda: report_of(context, job))
    return result.respond(if_none_match, "", lambda: Response(result.content(), media_type=form))


@ROUTER.get(
    "/{job_id}/report",
    response_class=HTMLResponse,
    summary="Read the report",
    responses=problems(404, 409) | {200: {"description": "One HTML file that opens offline"}} | UNCHANGED,
)
def read_report(context: ContextOf, job_id: str, if_none_match: IfNoneMatch = None) -> Response:
    """Read the report: one HTML file with figures and tables, without scripts."""
    job = find_job(context, job_id)
    return result_of(context, job).respond(if_none_match, "report", lambda: report_of(context, job))


@ROUTER.get(
    "/{job_id}/results/{artifact}",
    response_class=Response,
    summary="Read an export file",
    responses=problems(404, 409, 422) | {200: {"content": CONTENT, "description": "The file"}} | UNCHANGED,
)
def read_artifact(
    context: ContextOf,
    job_id: str,
    artifact: Annotated[str, Path(examples=[*ARTIFACTS, TRACES_FILE])],
    if_none_match: IfNoneMatch = None,
) -> Response:
    """Read the identified robot in an exchange format."""
    job = find_job(context, job_id)
    if artifact == TRACES_FILE:
        return file_response(traces_of(context, job), artifact, TRACES_TYPE, if_none_match)
    result = result_of(context, job)
    known = [*kind_of(job.request.kind).artifacts, TRACES_FILE]
    if artifact not in known:
        raise Problem(
            "not-found",
            f"the result has no file {artifact}",
            evidence={"artifact": artifact, "known": known},
            remedy="ask for one of the known files",
        )
    response = result.respond(if_none_match, artifact, lambda: _artifact(result, artifact))
    response.headers["Content-Disposition"] = f'attachment; filename="{artifact}"'
    return response


@ROUTER.delete(
    "/{job_id}",
    response_model=Job,
    summary="Dismiss a job, or delete a finished one",
    responses=problems(404, 409)
    | {
        200: {"description": "The job was unfinished and is now dismissed"},
        204: {"description": "The job was finished and is deleted"},
    },
)
def delete_job(context: ContextOf, job_id: str) -> Response:
    """Dismiss an unfinished job, which ends its computation; delete a finished one with its result."""
    job = find_job(context, job_id)
    if job.finished:
        context.queue.refuse_if_needed(reference=job.id)
    if job.finished and context.store.jobs.remove(job.id):
        return Response(status_code=204)
    return JSONResponse(job_document(context.queue.dismiss(job)))


def _job_response(job: JobRecord, *, applied: int | None) -> Response:
    headers = {"Location": f"/v1/jobs/{job.id}"}
    if applied is not None:
        headers["Preference-Applied"] = f"wait={applied}"
    if job.finished:
        return JSONResponse(job_document(job), 200, headers=headers)
    return JSONResponse(job_document(job), 202, headers=headers | {"Retry-After": RETRY_AFTER_S})


def _form(accept: str | None, forms: tuple[str, ...]) -> str:
    form = preferred(accept, forms)
    if form is None:
        raise Problem(
            "not-acceptable",
            f"results do not come as {accept}",
            evidence={"accept": accept, "known": list(forms)},
            remedy="accept one of the known forms",
        )
    return form


def _forms_of(kind: JobKind[Any]) -> tuple[str, ...]:
    offered = (True, PARAMETERS_FILE in kind.artifacts, kind.has_report)
    return tuple(compress(RESULT_FORMS, offered))


def _artifact(result: Blob, artifact: str) -> Response:
    form = ARTIFACTS[artifact]
    return Response(form.write(json.loads(result.content())), media_type=form.media_type)
