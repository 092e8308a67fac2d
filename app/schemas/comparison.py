"""Describe the document of a comparison of estimators."""

from typing import Annotated, Literal

from pydantic import Field, JsonValue

from .common import HeldOutSpan, JointFit, Open, about
from .conflicts import Conflict
from .results import Estimation


class Failure(Open):
    """Why an estimator gave nothing."""

    cause: str
    evidence: dict[str, JsonValue]
    remedy: str


class ComparedParameter(Open):
    """A base parameter by one estimator."""

    name: Annotated[str, Field(examples=["ZZR1"])]
    unit: str
    value: float
    standard_deviation: Annotated[float | None, about("null if the motion does not excite it")]
    relative_deviation_percent: Annotated[float | None, about("%P")]


class SimulatedMotion(Open):
    """Errors of motion that is simulated from measured states, on held-out blocks."""

    horizons_s: list[float]
    windows: int
    position_rms: Annotated[list[list[float]], about("per horizon and joint, rad or m")]
    velocity_rms: Annotated[list[list[float]], about("per horizon and joint, rad/s or m/s")]
    steady_rms: Annotated[
        list[list[float]], about("the same in position for a robot that keeps its velocity")
    ]


class ComparedEstimator(Open):
    """What one estimator gave, at which cost."""

    estimator: str
    title: str
    cpu_seconds: Annotated[float, about("processor time of fit and judgement")]
    failure: Failure | None
    feasible: Annotated[bool | None, about("whether its robot is physically consistent")]
    base_parameters: Annotated[list[ComparedParameter], about("empty if it failed")]
    fit_total_percent: float | None
    validation: Annotated[list[JointFit], about("on held-out blocks")]
    validation_total_percent: Annotated[float | None, about("of the torque's RMS, on held-out blocks")]
    estimation: Estimation | None
    simulated_motion: SimulatedMotion | None
    simulated_motion_note: Annotated[str, about("why nothing was simulated; empty where it was")]


class NamedParameter(Open):
    """A base parameter and what it groups."""

    name: str
    unit: str
    joint: int
    grouping: str


class ComparisonDocument(Open):
    """Several estimators on the same logs."""

    schema_version: str
    kind: Literal["compare"]
    robot: dict[str, JsonValue]
    logs: list[dict[str, JsonValue]]
    provenance: dict[str, JsonValue]
    counts: dict[str, int | None]
    terms: list[str]
    held_out: list[HeldOutSpan]
    condition_number: float | None
    defects: list[JsonValue]
    doubts: Annotated[list[str], about("warnings, as sentences; conflicts come first")]
    conflicts: Annotated[list[Conflict], about("what robot and logs disagree in")] = Field(default=[])
    parameters: list[NamedParameter]
    compared: list[ComparedEstimator]
