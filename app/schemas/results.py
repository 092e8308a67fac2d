"""Describe the result document; it is stored and sent as the bytes that the computation wrote."""

from typing import Annotated, Literal

from pydantic import Field, JsonValue

from .common import Open
from .diagnosis import Diagnosis
from .fit import HeldOutSpan, JointFit


class BaseParameter(Open):
    """A combination of standard parameters, how large it is and how well it is known."""

    name: Annotated[str, Field(examples=["ZZR1"])]
    joint: int
    unit: Annotated[str, Field(examples=["kg m2"])]
    value: Annotated[float, Field(description="of the robot that can exist")]
    value_ols: Annotated[float, Field(description="of ordinary least squares, which knows nothing of bodies")]
    standard_deviation: float
    relative_deviation_percent: Annotated[float | None, Field(description="%P")]
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
    """A link's body as the solid ellipsoid of even density with the same mass, mass centre and inertia."""

    link: Annotated[int, Field(description="counted from 1; what follows is in its frame")]
    mass: Annotated[float, Field(description="kg")]
    mass_centre: Annotated[list[float], Field(min_length=3, max_length=3, description="m")]
    half_axes: Annotated[
        list[float] | None, Field(description="m, ascending; null where no such body can exist")
    ]
    axes: Annotated[list[list[float]] | None, Field(description="their directions, as columns of a rotation")]


class ResultDocument(Open):
    """The identified robot: its parameters, how well each is known, and how well it predicts."""

    schema_version: str
    kind: Literal["identify", "diagnose"]
    robot: dict[str, JsonValue]
    logs: list[dict[str, JsonValue]]
    provenance: dict[str, JsonValue]
    counts: Annotated[dict[str, int | None], Field(examples=[{"standard": 98, "base": 71, "essential": 57}])]
    base_parameters: list[BaseParameter]
    standard_parameters: list[StandardParameter]
    bodies: Annotated[
        list[Body], Field(description="one feasible representative of each link; none where not modelled")
    ] = Field(default=[])
    feasibility: dict[str, JsonValue]
    solver: dict[str, JsonValue]
    fit: list[JointFit]
    validation: Annotated[list[JointFit], Field(description="on blocks that the fit has not seen")]
    held_out: list[HeldOutSpan] = Field(default=[])
    condition_number: float | None
    defects: list[JsonValue]
    doubts: Annotated[
        list[str], Field(description="sentences: what deserves a second look before it is used")
    ]
    diagnosis: Annotated[Diagnosis | None, Field(description="of a job of kind diagnose")] = None
