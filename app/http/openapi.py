"""Write the contract as OpenAPI 3.1: the routes, the bodies they read by hand, and the problems.

Routes read bodies themselves, so that they can be streamed, bounded and refused with reasons; their
documentation is given here.
"""

from typing import Any

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi
from pydantic import BaseModel
from pydantic.json_schema import models_json_schema

from ..kinds.registry import KINDS as JOB_KINDS
from ..problems import KINDS, MEDIA_TYPE
from ..schemas.audit import AuditRequest
from ..schemas.common import ProblemDocument
from ..schemas.jobs import JobRequest
from ..schemas.logs import LogReading
from ..schemas.robots import RobotDescription

SCHEMAS = "#/components/schemas/"
DOCUMENTED: tuple[type[BaseModel], ...] = (
    RobotDescription,
    AuditRequest,
    JobRequest,
    LogReading,
    *dict.fromkeys(kind.result for kind in JOB_KINDS.values()),
    ProblemDocument,
)
KEY = {
    "type": "http",
    "scheme": "bearer",
    "description": "API key created by the operator; not needed while the service listens on loopback only",
}
_KINDS = "\n".join(f"- A job of kind `{kind.name}`: {kind.words.hint}" for kind in JOB_KINDS.values())
DESCRIPTION = f"""Physically consistent dynamic identification of robots from their logs.

Create a robot (or use a built-in one), upload a log, create a job, read its results.

{_KINDS}

Those that identify have an HTML report at `/v1/jobs/{{job_id}}/report`.
SI units, angles in rad, joints counted from 1. Numbers are finite: no request or response contains NaN or
Infinity. Every failure is a problem document (RFC 9457) with cause, evidence and remedy."""


def reference(model: type[BaseModel]) -> dict[str, str]:
    """Refer to a model of the contract."""
    return {"$ref": SCHEMAS + model.__name__}


def body(content: dict[str, Any]) -> dict[str, Any]:
    """Document the body of a request, by media type."""
    return {"requestBody": {"required": True, "content": content}}


def file_part(description: str) -> dict[str, Any]:
    """Document a file in a form."""
    return {"type": "string", "format": "binary", "description": description}


def text_part(description: str, default: str) -> dict[str, Any]:
    """Document a text in a form; without a default Swagger UI would send the word "string"."""
    return {"type": "string", "description": description, "default": default}


def problems(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """Document which failures a route answers with."""
    return {
        status: {"description": "; ".join(title for code, title in KINDS.values() if code == status)}
        for status in statuses
    }


def document(app: FastAPI) -> dict[str, Any]:
    """Write the contract of an app."""
    contract = get_openapi(
        title=app.title,
        version=app.version,
        openapi_version=app.openapi_version,
        summary=app.summary,
        description=DESCRIPTION,
        routes=app.routes,
        tags=app.openapi_tags,
        license_info=app.license_info,
    )
    schemas = contract.setdefault("components", {}).setdefault("schemas", {})
    _, definitions = models_json_schema(
        [(model, "validation") for model in DOCUMENTED], ref_template=SCHEMAS + "{model}"
    )
    schemas |= definitions["$defs"]
    for name in ("HTTPValidationError", "ValidationError"):  # replaced by problem documents
        schemas.pop(name, None)
    contract["components"]["schemas"] = dict(sorted(schemas.items()))
    contract["components"]["securitySchemes"] = {"key": KEY}
    for path, operations in contract["paths"].items():
        for method, operation in operations.items():
            if path.startswith("/v1/"):
                operation["security"] = [{"key": []}, {}]
                operation["responses"] |= _shared_problems(method)
            _state_problems(operation)
    return contract


def _shared_problems(method: str) -> dict[str, Any]:
    """Document which failures every resource may answer with."""
    shared = problems(400, 401, 403, 408, 421, 422, 429, 431, 503)
    if method == "post":
        shared |= problems(507)
    return {str(status): answer for status, answer in shared.items()}


def _state_problems(operation: dict[str, Any]) -> None:
    answers = operation["responses"]
    for status, answer in answers.items():
        if int(status) >= 400:
            answer["content"] = {MEDIA_TYPE: {"schema": reference(ProblemDocument)}}
            if status == "422" and answer["description"] == "Validation Error":
                answer["description"] = KINDS["request"][1]
    operation["responses"] = dict(sorted(answers.items()))
