"""Describe conflicts in a result document: what robot and logs disagree in, and the correction to paste."""

from typing import Annotated, Literal

from pydantic import Field, JsonValue

from .common import Open, about

ConflictName = Literal[
    "torque_sign",
    "position_sign",
    "channels_swapped",
    "mounting",
    "zero_quarter_turn",
    "zero_offset",
    "convention",
    "link_length",
    "gravity_compensated",
    "position_linkage",
    "time_base",
    "time_offset",
    "unit",
    "gear_ratio",
    "other_signal",
]
Channel = Annotated[Literal["torque", "position", "both"] | None, about("null if the description is wrong")]


class OtherConflict(Open):
    """A conflict that predicts the logs as well."""

    conflict: ConflictName
    joints: list[int]
    channel: Channel
    why: str


class Correction(Open):
    """What to paste; it holds the corrections of all conflicts together."""

    mapping: Annotated[dict[str, JsonValue], about("mapping of the first log; empty if it is right")]
    robot: Annotated[
        dict[str, JsonValue], about("fields of the description to replace; empty if it is right")
    ]
    mappings: Annotated[
        list[dict[str, JsonValue]] | None, about("mappings of all logs, where there are several")
    ] = None


class Conflict(Open):
    """A disagreement of robot and logs that one correction removes."""

    conflict: ConflictName
    joints: Annotated[list[int], about("empty if it concerns the whole robot")]
    channel: Channel
    confidence: Annotated[float, Field(ge=0.0, le=1.0)]
    error_before_percent: Annotated[
        float | None,
        about(
            "geometric mean, over joints whose torque is used, of residual over torque, RMS, on rows not "
            "fitted; null for time_base"
        ),
    ]
    error_after_percent: float | None
    joint_errors_before_percent: list[float] = Field(default=[])
    joint_errors_after_percent: list[float] = Field(default=[])
    applied: Annotated[bool, about("whether all other results are of the corrected set-up")]
    statement: str
    remedy: str
    correction: Correction
    ambiguous_with: Annotated[list[OtherConflict], about("what cannot be distinguished from it")]
