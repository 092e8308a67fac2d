"""Find a job and what it left: its result, its traces; or say why there are none."""

from ..http.immutable_response import Result
from ..problems import Problem
from ..store.records import JobRecord
from .job_feed import no_such_job
from .services import Desk

RETRY_AFTER_S = "1"


def find_job(desk: Desk, job_id: str) -> JobRecord:
    """Find a job.

    Raises
    ------
    Problem
        If there is none (404).
    """
    job = desk.store.jobs.get(job_id)
    if job is None:
        raise no_such_job(job_id)
    return job


def result_of(desk: Desk, job: JobRecord) -> Result:
    """Give a job's result document.

    Raises
    ------
    Problem
        If it has none: it is not finished, or failed, or was dismissed (409).
    """
    if job.result_sha256 is not None:
        return Result(job.result_sha256, desk.store.blobs.path(job.result_sha256))
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


def traces_of(desk: Desk, job: JobRecord) -> Result:
    """Give what a job computed instant by instant.

    Raises
    ------
    Problem
        If it has no result (409), or kept no traces (404).
    """
    result_of(desk, job)
    if job.traces_sha256 is None:
        raise Problem(
            "not-found",
            "the job kept no traces, only its result",
            evidence={"job": job.id},
            remedy="delete the job and ask for it again: it was computed by an earlier version",
        )
    return Result(job.traces_sha256, desk.store.blobs.path(job.traces_sha256))
