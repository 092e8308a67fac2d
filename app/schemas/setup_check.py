"""Describe the document of a set-up check."""

from typing import Annotated, Literal

from pydantic import Field, JsonValue

from .common import HeldOutSpan, JointFit, Open, about
from .conflicts import Conflict

Answer = Literal["yes", "needs_motion", "never"]


class Identifiable(Open):
    """How well these logs determine a base parameter."""

    name: Annotated[str, Field(examples=["ZZR1"])]
    joint: int
    unit: Annotated[str, Field(examples=["kg m2"])]
    grouping: Annotated[str, Field(examples=["ZZ1 + IA1 + YY2"])]
    relative_deviation_percent: Annotated[float | None, about("%P")]
    identifiable: Annotated[
        Literal["yes", "poorly", "needs_motion"], about("poorly: %P above 30; needs_motion: not excited")
    ]


class SmallestEffect(Open):
    """Approximate size from which a cause would be found."""

    joints: Annotated[list[int], about("empty if it concerns the whole robot")]
    name: Annotated[str, Field(examples=["excess_torque"])]
    unit: Annotated[str, Field(examples=["N m"])]
    bound: Annotated[
        Literal["at_least", "at_most"], about("at_most: the number falls as the effect grows, as a stiffness")
    ]
    value: float


class ShownCause(Open):
    """Whether these logs can show a cause of simulation error."""

    cause: Annotated[str, Field(examples=["friction_stribeck"])]
    title: str
    visible: bool
    not_on_joints: Annotated[list[int], about("there the parameters of the model absorb it")]
    smallest: list[SmallestEffect]
    experiment: Annotated[str, about("the motion that shows it")]


class CausePair(Open):
    """Two causes that these logs do not distinguish."""

    causes: Annotated[list[str], Field(min_length=2, max_length=2)]
    answer: Answer
    joints: list[int]
    why: str
    experiment: Annotated[str, about("what separates them")]


class CheckDocument(Open):
    """Whether robot and logs belong together, and what these logs can show."""

    schema_version: str
    kind: Literal["check"]
    agreement: Annotated[
        Literal["yes", "after_correction", "doubtful"],
        about("after_correction: all that follows is of the corrected set-up"),
    ]
    conflicts: Annotated[list[Conflict], about("what robot and logs disagree in")]
    doubts: Annotated[list[str], about("warnings, as sentences; conflicts come first")]
    robot: dict[str, JsonValue]
    logs: list[dict[str, JsonValue]]
    provenance: dict[str, JsonValue]
    counts: Annotated[dict[str, int | None], Field(examples=[{"standard": 98, "base": 71, "essential": 57}])]
    terms: list[str]
    fit: list[JointFit]
    validation: Annotated[list[JointFit], about("on held-out blocks")]
    held_out: list[HeldOutSpan]
    condition_number: float | None
    defects: list[JsonValue]
    identifiable: Annotated[list[Identifiable], about("per base parameter")]
    shown: Annotated[
        list[ShownCause], about("per cause that acts all the time; empty for logs too short for a diagnosis")
    ]
    separable: Annotated[dict[str, dict[str, Answer]], about("causes by causes")]
    not_separable: Annotated[list[CausePair], about("pairs of visible causes whose answer is not yes")]
