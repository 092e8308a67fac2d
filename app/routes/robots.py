"""Serve robots: created from a description or a URDF, never changed, found by their content."""

from typing import Annotated

import anyio
from fastapi import Header, Query, Request, Response
from fastapi.responses import JSONResponse

from ..http.body.json_body import check, parse_json, require_media_type
from ..http.negotiation import wait_seconds
from ..http.openapi import body, problems, reference
from ..http.pagination import CursorOf, Limit, before, following
from ..http.routing import chapter
from ..jobs.queue import Submission
from ..kinds.audit import Audit, audit_description
from ..problems import Problem
from ..schemas.audit import AuditDocument, AuditRequest
from ..schemas.examples import PENDULUM_URDF, YUMI_LEFT
from ..schemas.jobs import Job
from ..schemas.robots import BaseParameters, Robot, RobotDescription, RobotList
from ..services.finished_jobs import RETRY_AFTER_S
from ..services.job_feed import wait_for
from ..services.serialisers import job_document, robot_document, robot_summary
from ..services.services import ContextOf, ServicesOf
from ..store.records import Document

ROUTER = chapter("/v1/robots", tag="robots")
XML_TYPES = ("application/xml", "text/xml")
LinkName = Annotated[str | None, Query(max_length=200)]
TipLinks = Annotated[
    str | None, Query(max_length=2000, description="URDF: the last link, or several separated by commas")
]


@ROUTER.post(
    "",
    status_code=201,
    response_model=Robot,
    summary="Create a robot from a description or a URDF",
    responses=problems(400, 413, 415, 422),
    openapi_extra=body(
        {
            "application/json": {"schema": reference(RobotDescription), "example": YUMI_LEFT},
            "application/xml": {"schema": {"type": "string"}, "example": PENDULUM_URDF},
        }
    ),
)
async def create_robot(
    request: Request,
    context: ContextOf,
    base_link: LinkName = None,
    tip_link: TipLinks = None,
    gravity: Annotated[
        str | None,
        Query(max_length=100, description="URDF: x,y,z in m/s2 in the base frame; default 0,0,-9.81"),
    ] = None,
) -> Response:
    """Create a robot. The same content gives the same robot."""
    media_type = require_media_type(request, ("application/json", *XML_TYPES))
    content = await request.body()
    if media_type in XML_TYPES:
        vector = _vector(gravity)
        robot = await anyio.to_thread.run_sync(
            lambda: context.catalogue.add_urdf(
                content, base_link=base_link, tip_link=tip_link, gravity=vector
            )
        )
    else:
        _refuse_urdf_options(base_link=base_link, tip_link=tip_link, gravity=gravity)
        robot = await anyio.to_thread.run_sync(context.catalogue.add_description, parse_json(content))
    return JSONResponse(robot_document(robot), 201, headers={"Location": f"/v1/robots/{robot.id}"})


@ROUTER.get("", response_model=RobotList, summary="List robots", responses=problems(422))
def list_robots(context: ContextOf, limit: Limit = 100, cursor: CursorOf = None) -> Response:
    """List robots: built-in ones first, then the newest."""
    robots = context.catalogue.robots(limit=limit, before=before(cursor))
    listed = {"robots": [robot_summary(robot) for robot in robots]}
    return JSONResponse(listed | {"next": following(robots, limit)})


@ROUTER.get("/{robot_id}", response_model=Robot, summary="Read a robot", responses=problems(404))
def read_robot(context: ContextOf, robot_id: str) -> Response:
    """Read a robot with every default of its description filled in."""
    return JSONResponse(robot_document(context.catalogue.robot(robot_id)))


@ROUTER.get(
    "/{robot_id}/base-parameters",
    response_model=BaseParameters,
    summary="Read the base parameters",
    responses=problems(404, 422),
)
async def read_base_parameters(services: ServicesOf, context: ContextOf, robot_id: str) -> Response:
    """Read the base parameters of a robot with their groupings.

    Right after the very first start the answer waits until the solver is compiled.
    """
    robot = await anyio.to_thread.run_sync(context.catalogue.robot, robot_id)
    await services.readiness.wait_for_solver()
    document = await anyio.to_thread.run_sync(context.catalogue.base_parameters, robot)
    return JSONResponse(document)


@ROUTER.post(
    "/{robot_id}/audit",
    response_model=AuditDocument,
    summary="Audit the bodies of a description",
    responses=problems(400, 404, 413, 415, 422)
    | {202: {"model": Job, "description": "With logs: the job of kind `audit` that answers; follow it"}},
    openapi_extra=body(
        {
            "application/json": {
                "schema": reference(AuditRequest),
                "example": {"options": {"makers_mass": 11.0}},
            }
        }
    ),
)
async def audit_robot(
    request: Request,
    context: ContextOf,
    robot_id: str,
    prefer: Annotated[
        str | None, Header(max_length=200, description="wait=N: with logs, wait up to N seconds (at most 60)")
    ] = None,
) -> Response:
    """Find impossible masses, mass centres and inertias; with logs, a job finds those they contradict."""
    require_media_type(request, ("application/json",))
    asked = check(AuditRequest, parse_json(await request.body()))
    robot = await anyio.to_thread.run_sync(context.catalogue.robot, robot_id)
    options: Document = dict(asked.options)
    if not asked.logs:
        document = await anyio.to_thread.run_sync(audit_description, robot.description, options)
        return JSONResponse(document)
    submission = Submission(Audit.name, robot.id, tuple(asked.logs), options, trace=request.state.trace)
    job = await context.batcher.take(context.caller.tenant, context.queue.begin_to_submit, submission)
    seconds = wait_seconds(prefer)
    if seconds is not None:
        job = await wait_for(context.feed, job, seconds)
    headers = {"Location": f"/v1/jobs/{job.id}", "Retry-After": RETRY_AFTER_S}
    return JSONResponse(job_document(job), 202, headers=headers)


@ROUTER.delete("/{robot_id}", status_code=204, summary="Delete a robot", responses=problems(404, 409))
def delete_robot(context: ContextOf, robot_id: str) -> None:
    """Delete a robot that no unfinished job needs. Built-in robots stay."""
    context.queue.refuse_if_needed(robot=robot_id)
    context.catalogue.remove_robot(robot_id)


def _vector(text: str | None) -> tuple[float, ...] | None:
    if text is None:
        return None
    try:
        parts = tuple(float(part) for part in text.split(","))
    except ValueError:
        parts = ()
    if len(parts) != 3:
        raise Problem(
            "request",
            "gravity is not three numbers",
            evidence={"parameter": "gravity", "given": text},
            remedy="write it as gravity=0,0,-9.81",
        )
    return parts


def _refuse_urdf_options(**options: str | None) -> None:
    given = [name for name, value in options.items() if value is not None]
    if given:
        raise Problem(
            "request",
            f"{given[0]} belongs to a URDF, not to a description",
            evidence={"parameters": given},
            remedy="leave it out, or write gravity into the description",
        )
