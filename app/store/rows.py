"""Turn rows of the database into records."""

import json
from typing import Any

from sqlalchemy import Row

from .records import JobRecord, JobRequestRecord, LogRecord, RobotRecord


def request_record(text: str) -> JobRequestRecord:
    """Read what was asked for."""
    asked = json.loads(text)
    return JobRequestRecord(asked["kind"], asked["robot"], tuple(asked["logs"]), asked["options"])


def job_record(row: Row[Any]) -> JobRecord:
    """Read a job."""
    return JobRecord(
        tenant=row.tenant,
        id=row.id,
        sequence=row.sequence,
        request=request_record(row.request),
        trace=row.trace,
        state=row.state,
        stage=row.stage,
        fraction=row.fraction,
        attempts=row.attempts,
        token=row.token,
        version=row.version,
        problem=None if row.problem is None else json.loads(row.problem),
        result_sha256=row.result_sha256,
        traces_sha256=row.traces_sha256,
        created_at=row.created_at,
        started_at=row.started_at,
        finished_at=row.finished_at,
    )


def log_record(row: Row[Any]) -> LogRecord:
    """Read a log's summary."""
    return LogRecord(row.id, row.sequence, row.sha256, json.loads(row.document), row.created_at)


def robot_record(row: Row[Any]) -> RobotRecord:
    """Read a robot."""
    document = json.loads(row.document)
    return RobotRecord(
        id=row.id,
        sequence=row.sequence,
        name=document["name"],
        joints=document["joints"],
        built_in=False,
        description=document["description"],
        suspicions=tuple(document["suspicions"]),
        created_at=row.created_at,
    )
