"""Share what all models have in common: strict types, no unknown fields, finite numbers, bounded lengths."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, JsonValue


class Strict(BaseModel):
    """Refuse what the contract does not name."""

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False, frozen=True)


class Open(BaseModel):
    """Describe an answer, to which later versions may add fields."""

    model_config = ConfigDict(extra="allow", strict=True, allow_inf_nan=False, frozen=True)


Identity = Annotated[str, Field(min_length=1, max_length=64, examples=["yumi-left"])]
Name = Annotated[str, Field(max_length=200)]
Options = Annotated[dict[str, JsonValue], Field(max_length=100)]
Instant = Annotated[str, Field(description="ISO 8601, UTC", examples=["2026-01-31T12:00:00.000+00:00"])]


Next = Annotated[str | None, Field(description="`cursor` of the next page; null where this is the last")]


class ProblemDocument(Open):
    """An RFC 9457 problem document: what went wrong, what was seen, what to do about it."""

    type: Annotated[
        str, Field(examples=["urn:veritorque:problem:log"], description="stable name of the kind of problem")
    ]
    title: str
    status: int
    detail: str
    cause: Annotated[str, Field(description="what is wrong")]
    evidence: Annotated[
        dict[str, JsonValue], Field(description="the numbers, names and JSON pointers that show it")
    ]
    remedy: Annotated[str, Field(description="what to change")]
