"""Answer with the report of a job: one page that opens offline and can do nothing but be read."""

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from fastapi.responses import HTMLResponse

from app.finished import result_of
from app.results import Result
from app.services import Desk
from app.store.records import JobRecord
from core.log.preview import FEWEST_POINTS
from core.report.page.page import POLICY, compose_page
from core.report.page.running import Origin
from core.report.page.traces import EXTENDED, FILTERED, MEASURED, MOTION, PLAIN, JointTraces
from core.report.traces.reading import Traces, View, read_traces

FRAMED = "; frame-ancestors 'none'; sandbox"
"""What only a header may say: the page is shown nowhere else, and runs nothing."""
POINTS_TOGETHER = 4000
"""Points of all joints of a page together, so that a robot of many joints makes no page of many megabytes."""


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
    traces = [*_traces(desk, job, document)] if job.traces_sha256 else []
    page = compose_page(document, origin=Origin(job.id, job.finished_at or ""), traces=traces)
    return HTMLResponse(page, headers={"Content-Security-Policy": POLICY + FRAMED})


def _traces(desk: Desk, job: JobRecord, document: dict[str, Any]) -> Iterator[JointTraces]:
    kept = Result(str(job.traces_sha256), desk.store.blobs.path(str(job.traces_sha256)))
    kept.check()
    extended = bool(document.get("diagnosis") and document["diagnosis"]["after"].get("base_parameters"))
    signals = (*MOTION, MEASURED, FILTERED, *(EXTENDED if extended else PLAIN))
    logs, joints = len(document["logs"]), len(document["fit"])
    points = max(POINTS_TOGETHER // (logs * joints), FEWEST_POINTS)
    for log in range(1, logs + 1):
        for joint in range(1, joints + 1):
            view = View(log, joint, signals, points=points)
            yield _drawable(view, read_traces(Path(kept.path), view))


def _drawable(view: View, traces: Traces) -> JointTraces:
    columns = zip(view.signals, traces.values.T.tolist(), strict=True)
    return JointTraces(
        log=view.log,
        joint=view.joint,
        time=traces.time.tolist(),
        signals={name: [one if math.isfinite(one) else None for one in column] for name, column in columns},
        units=dict(zip(view.signals, traces.units, strict=True)),
        held_out=traces.held_out,
    )
