"""Find a job, its result, its traces and its report, or say why there are none."""

import json

from fastapi.responses import HTMLResponse

from ...core.report.page.page import POLICY
from ...core.report.page.running import Origin
from ..http.immutable_response import Blob
from ..kinds.registry import kind_of
from ..problems import Problem
from ..store.records import JobRecord
from .job_feed import no_such_job
from .services import RequestContext

RETRY_AFTER_S = "1"
FRAMED = "; frame-ancestors 'none'; sandbox"
"""What only a header may say: the page is shown nowhere else, and runs nothing."""


def find_job(context: RequestContext, job_id: str) -> JobRecord:
    """Find a job.

    Raises
    ------
    Problem
        If there is none (404).
    """
    job = context.store.jobs.get(job_id)
    if job is None:
        raise no_such_job(job_id)
    return job


def result_of(context: RequestContext, job: JobRecord) -> Blob:
    """Give a job's result document.

    Raises
    ------
    Problem
        If it has none: it is not finished, or failed, or was dismissed (409).
    """
    if job.result_sha256 is not None:
        return Blob(job.result_sha256, context.store.blobs)
    if job.state == "failed":
        evidence = {"state": job.state, "problem": job.problem}
        cause = str((job.problem or {}).get("cause", "the job failed"))
        raise Problem(
            "job-failed", cause, evidence=evidence, remedy=str((job.problem or {}).get("remedy", ""))
        )
    if job.state == "dismissed":
        raise Problem(
            "job-dismissed", "the job was dismissed", evidence={"state": job.state}, remedy="ask for it again"
        )
    raise Problem(
        "job-unfinished",
        "the job is not finished",
        evidence={"state": job.state, "stage": job.stage, "fraction": job.fraction},
        remedy=f"follow /v1/jobs/{job.id} until its state is successful",
        headers={"Retry-After": RETRY_AFTER_S},
    )


def traces_of(context: RequestContext, job: JobRecord) -> Blob:
    """Give the torques and residuals of every sample.

    Raises
    ------
    Problem
        If it has no result (409), or kept no traces (404).
    """
    result_of(context, job)
    if job.traces_sha256 is None:
        raise Problem(
            "not-found",
            "the job kept no traces, only its result",
            evidence={"job": job.id},
            remedy="read its result: only identify and diagnose keep traces. If it is one of these, "
            "it was computed by an earlier version, and has to be deleted and asked for again",
        )
    return Blob(job.traces_sha256, context.store.blobs)


def report_of(context: RequestContext, job: JobRecord) -> HTMLResponse:
    """Write the report of a finished job as a page, with figures over time where its traces were kept.

    Raises
    ------
    Problem
        If the job has no result (409), or its kind no report (404).
    DamagedError
        If its result or its traces are missing, or do not have their digests.
    """
    kind = kind_of(job.request.kind)
    if not kind.has_report:
        raise Problem(
            "not-found",
            f"a job of kind {kind.name} has no report, only its result",
            evidence={"job": job.id},
            remedy=f"read /v1/jobs/{job.id}/results",
        )
    document = json.loads(result_of(context, job).content())
    origin = Origin(job.id, job.finished_at or "")
    if job.traces_sha256 is None:
        page = kind.report(document, None, origin)
    else:
        traces = Blob(job.traces_sha256, context.store.blobs)
        traces.check()
        with traces.local_copy() as file:
            page = kind.report(document, file, origin)
    return HTMLResponse(page, headers={"Content-Security-Policy": POLICY + FRAMED})
