"""Find what a job needs: the records that it names as a computation, and the blobs of that as local files."""

from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path

from ...core.errors import OptionError
from ..kinds.registry import kind_of
from ..problems import Problem
from ..store.blobs.blob_store import BlobStore
from ..store.records import Document, JobRecord
from ..store.store import TenantStore
from .computation import Computation, LogBlob, Workspace


def computation_of(job: JobRecord, store: TenantStore, built_in: Mapping[str, Document]) -> Computation:
    """Give the computation of a job.

    Parameters
    ----------
    built_in
        Descriptions of the built-in robots by id.

    Raises
    ------
    Problem
        If the robot or a log was deleted while the job waited (404), or the earlier job was (422).
    OptionError
        If the earlier job has no result.
    """
    request = job.request
    robot = store.robots.get(request.robot)
    description = robot.description if robot else built_in.get(request.robot)
    if description is None:
        raise _deletion_problem("robot", request.robot)
    reference = kind_of(request.kind).reference(request.options)
    return Computation(
        kind=request.kind,
        robot=description,
        logs=tuple(_log_blob(store, identity) for identity in request.logs),
        options=request.options,
        reference=None if reference is None else result_digest(store, reference),
    )


def result_digest(store: TenantStore, identity: str) -> str:
    """Give the digest of the result of an earlier job, which a request names as its reference.

    Raises
    ------
    Problem
        If there is no such job (422).
    OptionError
        If the job has no result.
    """
    job = store.jobs.get(identity)
    if job is None:
        raise Problem(
            "unknown-reference",
            f"there is no job {identity} to compare with",
            evidence={"reference": identity, "pointer": "/options/reference"},
            remedy='name a job of GET /v1/jobs, or "prior"',
        )
    if job.result_sha256 is None:
        raise OptionError(
            f"the job {identity} has no result to compare with: it is {job.state}",
            evidence={"reference": identity, "state": job.state, "pointer": "/options/reference"},
            remedy="wait until it is successful" if not job.finished else "name a job that was successful",
        )
    return job.result_sha256


@contextmanager
def open_workspace(computation: Computation, blobs: BlobStore, traces: Path) -> Iterator[Workspace]:
    """Give the blobs of a computation as local files until the context ends, and the file for its traces."""
    with ExitStack() as stack:
        files = {sha256: stack.enter_context(blobs.local_copy(sha256)) for sha256 in computation.digests}
        yield Workspace(files, traces)


def _log_blob(store: TenantStore, identity: str) -> LogBlob:
    log = store.logs.get(identity)
    if log is None:
        raise _deletion_problem("log", identity)
    mapping = log.summary["mapping"]
    return LogBlob(log.sha256, str(log.summary["name"]), mapping if isinstance(mapping, dict) else None)


def _deletion_problem(what: str, identity: str) -> Problem:
    return Problem(
        "not-found",
        f"the {what} {identity} was deleted while the job waited",
        evidence={what: identity},
        remedy="create it again and ask for the job again",
    )
