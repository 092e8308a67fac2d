"""Find the earlier job that a diagnosis names as its reference: there, finished, and of the same robot."""

from pathlib import Path

from ...core.errors import OptionError
from ..problems import Problem
from ..store.records import Document, RobotRecord
from ..store.store import TenantStore
from . import computations as science


def reference_file(store: TenantStore, kind: str, options: Document) -> Path | None:
    """Give the file of the result that a request compares with; None where it names no job.

    Raises
    ------
    Problem
        If there is no such job (422).
    OptionError
        If the job has no result.
    """
    name = science.reference_job(kind, options)
    if name is None:
        return None
    job = store.jobs.get(name)
    if job is None:
        raise Problem(
            "unknown-reference",
            f"there is no job {name} to compare with",
            evidence={"reference": name, "pointer": "/options/reference"},
            remedy='name a job of GET /v1/jobs, or "prior"',
        )
    if job.result_sha256 is None:
        raise OptionError(
            f"the job {name} has no result to compare with: it is {job.state}",
            evidence={"reference": name, "state": job.state, "pointer": "/options/reference"},
            remedy="wait until it is successful" if not job.finished else "name a job that was successful",
        )
    return store.blobs.path(job.result_sha256)


def check_reference(store: TenantStore, kind: str, robot: RobotRecord, options: Document) -> None:
    """Refuse a reference that cannot be compared with, before anything is computed.

    Raises
    ------
    Problem, OptionError
        If there is no such job, or it has no result, or that is another robot's.
    RobotError
        If the robot's own bodies are to be compared with and it brings none.
    """
    if kind == "diagnose":
        science.check_reference(robot.description, options, reference_file(store, kind, options))
