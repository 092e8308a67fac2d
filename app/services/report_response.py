"""Answer with the report of a job: one page that opens offline and can do nothing but be read."""

import json
from pathlib import Path

from fastapi.responses import HTMLResponse

from ...core.report.page.page import POLICY
from ...core.report.page.running import Origin
from ..http.immutable_response import Result
from ..store.records import JobRecord
from .finished_jobs import result_of
from .report import report_page
from .services import Desk

FRAMED = "; frame-ancestors 'none'; sandbox"
"""What only a header may say: the page is shown nowhere else, and runs nothing."""


def report_response(desk: Desk, job: JobRecord) -> HTMLResponse:
    """Draw the report of a finished job, with its traces where they were kept.

    Raises
    ------
    Problem
        If the job has no result.
    Damaged
        If its result or its traces are not what they were.
    """
    document = json.loads(result_of(desk, job).content())
    page = report_page(document, _traces(desk, job), Origin(job.id, job.finished_at or ""))
    return HTMLResponse(page, headers={"Content-Security-Policy": POLICY + FRAMED})


def _traces(desk: Desk, job: JobRecord) -> Path | None:
    if not job.traces_sha256:
        return None
    kept = Result(job.traces_sha256, desk.store.blobs.path(job.traces_sha256))
    kept.check()
    return Path(kept.path)
