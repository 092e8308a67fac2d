"""Describe requests for jobs, and jobs."""

from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field, JsonValue

from ..kinds.registry import KINDS
from .common import Identity, Instant, Next, Open, Options, ProblemDocument, Strict, about

if TYPE_CHECKING:
    Kind = str
else:
    Kind = Literal[tuple(KINDS)]
FEWEST_LOGS = int(all(kind.takes_logs for kind in KINDS.values()))
ANSWERS = " ".join(f"`{kind.name}`: {kind.words.hint}" for kind in KINDS.values())
State = Literal["accepted", "running", "successful", "failed", "dismissed"]


class JobRequest(Strict):
    """A request for a job: kind, robot and logs by id, and options."""

    kind: Annotated[Kind, about(f"what to compute. {ANSWERS}")]
    robot: Identity
    logs: Annotated[list[Identity], Field(min_length=FEWEST_LOGS, max_length=100)]
    options: Options = Field(
        default={}, description="unknown options are refused with the list of known ones"
    )


class Progress(Open):
    """Progress of a job."""

    stage: str
    fraction: Annotated[float, Field(ge=0, le=1)]


class Job(Open):
    """A job: request, progress, and outcome."""

    id: str
    kind: str
    robot: str
    logs: list[str]
    options: dict[str, JsonValue]
    state: State
    progress: Progress
    created_at: Instant
    started_at: Instant | None
    finished_at: Instant | None
    problem: Annotated[ProblemDocument | None, about("why a failed job has no results")]
    links: Annotated[dict[str, str], about("paths of this job and, once it is successful, of its results")]


class JobList(Open):
    """Jobs, the newest first."""

    jobs: list[Job]
    next: Next
