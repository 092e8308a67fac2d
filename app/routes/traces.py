"""Serve what a job computed instant by instant, for the eye."""

from typing import Annotated

from fastapi import Query, Response

from app.finished import find_job, traces_of
from app.looking import DEFAULT_SIGNALS, MOST_POINTS, traces_response, view_of
from app.openapi import problems
from app.results import UNCHANGED, IfNoneMatch
from app.routing import chapter
from app.schemas.traces import ResultTraces
from app.services import DeskOf

ROUTER = chapter("/v1/jobs", tag="jobs")
Stamp = Annotated[float | None, Query(allow_inf_nan=False, description="s on the log's own clock")]


@ROUTER.get(
    "/{job_id}/traces",
    response_model=ResultTraces,
    summary="Look at torque and motion",
    responses=problems(404, 409, 422) | UNCHANGED,
)
def read_traces(
    desk: DeskOf,
    job_id: str,
    joint: Annotated[int, Query(ge=1, description="counted from 1")],
    signals: Annotated[
        str, Query(max_length=200, description="their names, with commas between them")
    ] = DEFAULT_SIGNALS,
    log: Annotated[int, Query(ge=1, description="counted from 1, in the order of the job")] = 1,
    begin: Annotated[Stamp, Query(alias="from")] = None,
    end: Annotated[Stamp, Query(alias="to")] = None,
    points: Annotated[int, Query(ge=10, le=MOST_POINTS, description="the most points per trace")] = 2000,
    if_none_match: IfNoneMatch = None,
) -> Response:
    """Read signals of one joint with few points, of which no extreme is missing; from and to zoom in."""
    view = view_of(log, joint, signals, (begin, end), points)
    return traces_response(traces_of(desk, find_job(desk, job_id)), view, if_none_match)
