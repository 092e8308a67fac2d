"""Serve what a job computed instant by instant, for the eye."""

from fastapi import Response

from app.finished import find_job, traces_of
from app.looking import ViewOf, traces_response
from app.openapi import problems
from app.results import UNCHANGED, IfNoneMatch
from app.routing import chapter
from app.schemas.traces import ResultTraces
from app.services import DeskOf

ROUTER = chapter("/v1/jobs", tag="jobs")


@ROUTER.get(
    "/{job_id}/traces",
    response_model=ResultTraces,
    summary="Look at torque and motion",
    responses=problems(404, 409, 422) | UNCHANGED,
)
def read_result_traces(
    desk: DeskOf, job_id: str, view: ViewOf, if_none_match: IfNoneMatch = None
) -> Response:
    """Read signals of one joint with few points, of which no extreme is missing; from and to zoom in."""
    return traces_response(traces_of(desk, find_job(desk, job_id)), view, if_none_match)
