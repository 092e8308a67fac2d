"""Write records as the documents of the contract."""

from ..kinds.registry import KINDS
from ..store.records import Document, JobRecord, LogRecord, RobotRecord

PARAMETERS_FILE = "parameters.csv"


def robot_summary(robot: RobotRecord) -> Document:
    """Write a robot for a list."""
    return {
        "id": robot.id,
        "name": robot.name,
        "joints": robot.joints,
        "built_in": robot.built_in,
        "created_at": robot.created_at,
    }


def robot_document(robot: RobotRecord) -> Document:
    """Write a robot in full."""
    return robot_summary(robot) | {"suspicions": list(robot.suspicions), "description": robot.description}


def log_document(log: LogRecord) -> Document:
    """Write the summary of a log."""
    return {"id": log.id} | log.summary | {"created_at": log.created_at}


def job_document(job: JobRecord) -> Document:
    """Write a job."""
    path = f"/v1/jobs/{job.id}"
    links = {"self": path}
    if job.state == "successful":
        kind = KINDS[job.request.kind]
        links["results"] = f"{path}/results"
        if kind.has_report:
            links["report"] = f"{path}/report"
        if PARAMETERS_FILE in kind.artifacts:
            links["parameters_csv"] = f"{path}/results/{PARAMETERS_FILE}"
        if job.traces_sha256 is not None:
            links["traces"] = f"{path}/traces"
    return {
        "id": job.id,
        "kind": job.request.kind,
        "robot": job.request.robot,
        "logs": list(job.request.logs),
        "options": job.request.options,
        "state": job.state,
        "progress": {"stage": job.stage, "fraction": job.fraction},
        "created_at": job.created_at,
        "started_at": job.started_at,
        "finished_at": job.finished_at,
        "problem": job.problem,
        "links": links,
    }
