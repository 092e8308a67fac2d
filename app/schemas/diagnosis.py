"""Describe the diagnosis in a result document: what the simulation gets wrong, why, and what a cure gains."""

from typing import Annotated, Literal

from pydantic import Field, JsonValue

from app.schemas.common import Open

Matrix = list[list[float | None]]
PerJoint = list[float | None]
Interval = Annotated[list[float | None] | None, Field(description="ends of a 95 % interval", max_length=2)]


class JointFit(Open):
    """How well the model predicts the torque of a joint."""

    joint: int
    rms_torque: float
    rms_residual: float
    nrmse_of_range_percent: float | None
    nrmse_of_rms_percent: float | None


class FoundParameter(Open):
    """A number of a finding, and how well it is known."""

    name: Annotated[str, Field(examples=["load_coefficient"])]
    joint: Annotated[int | None, Field(description="None where it belongs to the whole robot")]
    unit: Annotated[str, Field(examples=["N m"])]
    value: float | None
    standard_deviation: float | None
    relative_deviation_percent: Annotated[float | None, Field(description="%P")]


class Evidence(Open):
    """A number that decided."""

    statement: str
    statistic: Annotated[str, Field(examples=["likelihood ratio"])]
    value: float | None


class Rival(Open):
    """Another cause that was weighed for the same trace."""

    cause: str
    title: str
    joints: list[int]
    statistic: float | None
    why: str
    separating_experiment: Annotated[str, Field(description="empty where the rival was refuted")]


class Gain(Open):
    """What a finding gains on rows that no fit has seen; lists have one entry per joint."""

    rms_residual_before: PerJoint
    rms_residual_after: PerJoint
    held_out: bool
    improvement_percent: PerJoint
    improvement_total_percent: float | None
    interval_95: Interval


class Curve(Open):
    """One joint's mean residual over the coordinate that explains it, in bins."""

    coordinate: Annotated[str, Field(examples=["position"])]
    unit: str
    joint: int
    centre: PerJoint
    before: PerJoint
    after: PerJoint
    model: PerJoint
    standard_error: PerJoint
    direction: Annotated[PerJoint, Field(description="1 forward motion, -1 backward motion, 0 both")]


class Finding(Open):
    """A named cause with everything that supports it."""

    cause: Annotated[str, Field(examples=["friction_load_dependent"])]
    title: str
    joints: list[int]
    statement: str
    confidence: Annotated[float, Field(ge=0, le=1)]
    p_value: float
    cure: Literal["term", "signal", "robot"]
    parameters: list[FoundParameter]
    explained_residual_fraction: float | None
    evidence: list[Evidence]
    ambiguous_with: list[Rival]
    refuted: list[Rival]
    gain: Gain | None
    curve: Curve | None


class NotIdentifiable(Open):
    """A cause that this motion could not have shown."""

    cause: str
    title: str
    joints: list[int]
    why: str
    separating_experiment: str


class Unexplained(Open):
    """What is left, per joint: the share a generic learner predicts, and how low noise goes."""

    joints: Annotated[list[int], Field(description="where structure is left")]
    predictable_residual_fraction: PerJoint
    interval_95: list[Interval]
    rms_residual: PerJoint
    places: list[list[dict[str, JsonValue]]]
    noise_floor: PerJoint
    noise_floor_source: list[str]


class JointGain(Open):
    """What the cure as a whole gains on one joint, on blocks that no fit has seen."""

    joint: int
    rms_residual_before: float
    rms_residual_after: float
    improvement_percent: float
    interval_95: Interval
    held_out: bool


class Side(Open):
    """The model before or after the cure, fitted and held out."""

    fit: list[JointFit] = Field(default=[])
    validation: list[JointFit]
    base_parameters: list[dict[str, JsonValue]] = Field(default=[])


class Motion(Open):
    """How far the simulated robot strays from the measured one; rows are horizons, columns joints."""

    horizons_s: list[float] = Field(default=[])
    windows: int = 0
    position_rms: Matrix = Field(default=[])
    velocity_rms: Matrix = Field(default=[])
    steady_rms: Annotated[Matrix, Field(description="of keeping the velocity")] = Field(default=[])


class Simulation(Open):
    """The model before and after the cure, made to move; empty, with a `note`, where that was not done."""

    before: Motion
    after: Motion
    note: str = ""
    improvement_percent: Matrix = Field(default=[])
    improvement_total_percent: PerJoint = Field(default=[])
    interval_95: list[Interval] | None = None


class Dependence(Open):
    """What is left of one joint's residual over one coordinate, in bins."""

    coordinate: str
    joint: int
    unit: str
    centre: PerJoint
    mean: PerJoint
    standard_error: PerJoint
    statistic: float | None
    p_value: float | None


class Diagnosis(Open):
    """What the simulation gets wrong, why, what was cured, and what is left."""

    verdict: Literal["causes_found", "nothing_found", "unexplained"]
    findings: list[Finding]
    not_identifiable: list[NotIdentifiable]
    unexplained: Unexplained
    gain: list[JointGain]
    before: Side
    after: Side
    simulation: Simulation
    atlas: list[Dependence]
