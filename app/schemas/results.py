"""Describe the result document; it is stored and sent as the computation wrote it."""

from typing import Annotated, Literal

from pydantic import Field, JsonValue

from .common import HeldOutSpan, JointFit, Open, about
from .conflicts import Conflict
from .diagnosis import Diagnosis


class BaseParameter(Open):
    """A base parameter: an identifiable combination of standard parameters."""

    name: Annotated[str, Field(examples=["ZZR1"])]
    joint: int
    unit: Annotated[str, Field(examples=["kg m2"])]
    value: Annotated[float, about("physically consistent estimate")]
    value_ols: Annotated[float, about("ordinary least squares, without the consistency constraint")]
    standard_deviation: float
    relative_deviation_percent: Annotated[float | None, about("%P")]
    essential: bool | None = None
    grouping: Annotated[str, Field(examples=["ZZ1 + IA1 + YY2"])]


class StandardParameter(Open):
    """One of the ten parameters of a link, or one of a joint's drive."""

    name: str
    joint: int
    unit: str
    value: float
    identifiable: Literal["individually", "in_combination", "no"]


class Body(Open):
    """A link's body as the ellipsoid of uniform density with the same mass, centre of mass and inertia."""

    link: Annotated[int, about("counted from 1; the other fields are in its frame")]
    mass: Annotated[float, about("kg")]
    mass_centre: Annotated[list[float], Field(min_length=3, max_length=3, description="m")]
    half_axes: Annotated[
        list[float] | None, about("m, ascending; null if the body is physically inconsistent")
    ]
    axes: Annotated[list[list[float]] | None, about("their directions, as columns of a rotation")]


class ModelName(Open):
    """Which model the parameters of a result are of."""

    name: Annotated[Literal["plain", "extended"], about("extended by the findings of a diagnosis, or plain")]
    statement: str


class PlainModel(Open):
    """The model of a diagnosis before any correction, with the fields of an identification."""

    counts: dict[str, int | None]
    base_parameters: list[BaseParameter]
    terms: list[str] = Field(default=[])
    standard_parameters: list[StandardParameter]
    bodies: list[Body] = Field(default=[])
    feasibility: dict[str, JsonValue]
    solver: dict[str, JsonValue]
    fit: list[JointFit]
    validation: list[JointFit]
    condition_number: float | None


class ResultDocument(Open):
    """The identified robot: parameters, standard deviations, and prediction errors."""

    schema_version: str
    kind: Literal["identify", "diagnose"]
    robot: dict[str, JsonValue]
    logs: list[dict[str, JsonValue]]
    provenance: dict[str, JsonValue]
    counts: Annotated[dict[str, int | None], Field(examples=[{"standard": 98, "base": 71, "essential": 57}])]
    model: Annotated[ModelName | None, about("the model that all of this describes")] = None
    base_parameters: list[BaseParameter]
    terms: Annotated[
        list[str],
        Field(description="the torque terms of the model", examples=[["rigid_body", "viscous", "coulomb"]]),
    ] = Field(default=[])
    standard_parameters: list[StandardParameter]
    bodies: Annotated[
        list[Body], about("one feasible representative of each link; empty if links are not modelled")
    ] = Field(default=[])
    feasibility: dict[str, JsonValue]
    solver: dict[str, JsonValue]
    fit: list[JointFit]
    validation: Annotated[list[JointFit], about("on held-out blocks")]
    held_out: list[HeldOutSpan] = Field(default=[])
    condition_number: float | None
    defects: list[JsonValue]
    doubts: Annotated[list[str], about("warnings, as sentences; conflicts come first")]
    conflicts: Annotated[list[Conflict], about("what robot and logs disagree in")] = Field(default=[])
    plain: Annotated[
        PlainModel | None, about("beside the extended model, the one before; null where they are the same")
    ] = None
    diagnosis: Annotated[Diagnosis | None, about("of a job of kind diagnose")] = None
