"""Serve what a job computed instant by instant, for the eye."""

from fastapi import Response

from ..http.immutable_response import UNCHANGED, IfNoneMatch
from ..http.openapi import problems
from ..http.routing import chapter
from ..schemas.traces import ResidualViews, ResultTraces
from ..services.decimated_traces import Number, ViewOf, traces_response, views_response
from ..services.finished_jobs import find_job, traces_of
from ..services.services import ContextOf

ROUTER = chapter("/v1/jobs", tag="jobs")


@ROUTER.get(
    "/{job_id}/traces",
    response_model=ResultTraces,
    summary="Read traces of a result",
    responses=problems(404, 409, 422) | UNCHANGED,
)
def read_result_traces(
    context: ContextOf, job_id: str, view: ViewOf, if_none_match: IfNoneMatch = None
) -> Response:
    """Read signals of one joint, min/max decimated; `from` and `to` select a range."""
    return traces_response(traces_of(context, find_job(context, job_id)), view, if_none_match)


@ROUTER.get(
    "/{job_id}/residuals",
    response_model=ResidualViews,
    summary="Read residuals",
    responses=problems(404, 409, 422) | UNCHANGED,
)
def read_residual_views(
    context: ContextOf, job_id: str, joint: Number, log: Number = 1, if_none_match: IfNoneMatch = None
) -> Response:
    """Read a joint's residual over position, velocity and frequency."""
    kept = traces_of(context, find_job(context, job_id))
    return views_response(kept, log=log, joint=joint, if_none_match=if_none_match)
