"""Declare what all models share: strict types, no unknown fields, finite numbers, bounded lengths."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, JsonValue
from pydantic.fields import FieldInfo


def about(text: str) -> FieldInfo:
    """Describe a field."""
    described: FieldInfo = Field(description=text)
    return described


class Strict(BaseModel):
    """A request model, which refuses unknown fields."""

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False, frozen=True)


class Open(BaseModel):
    """A response model, to which later versions may add fields."""

    model_config = ConfigDict(extra="allow", strict=True, allow_inf_nan=False, frozen=True)


Identity = Annotated[str, Field(min_length=1, max_length=64, examples=["yumi-left"])]
Options = Annotated[dict[str, JsonValue], Field(max_length=100)]
Instant = Annotated[str, Field(description="ISO 8601, UTC", examples=["2026-01-31T12:00:00.000+00:00"])]
Next = Annotated[str | None, about("`cursor` of the next page; null on the last page")]


class ProblemDocument(Open):
    """An RFC 9457 problem document: cause, evidence and remedy."""

    type: Annotated[
        str, Field(examples=["urn:veritorque:problem:log"], description="stable name of the kind of problem")
    ]
    title: str
    status: int
    detail: str
    cause: Annotated[str, about("what went wrong")]
    evidence: Annotated[dict[str, JsonValue], about("numbers, names and JSON pointers that support it")]
    remedy: Annotated[str, about("what to change")]


class JointFit(Open):
    """Torque prediction error of a joint."""

    joint: int
    samples: Annotated[int, about("0 for a joint that never moves; its numbers are null")] = 0
    rms_torque: float | None
    rms_residual: float | None
    nrmse_of_range_percent: float | None
    nrmse_of_rms_percent: float | None
    quality: Annotated[
        Literal["good", "fair", "poor", "failed"] | None,
        about("of an error of up to 10, 25, 50 per cent of the RMS torque, and above"),
    ] = None


class HeldOutSpan(Open):
    """A held-out span of a log."""

    log: Annotated[int, about("counted from 1")]
    begin_s: float
    end_s: float
