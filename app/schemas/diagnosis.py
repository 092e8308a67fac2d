"""Describe the diagnosis in a result document: what the simulation gets wrong, why, and what a cure gains."""

from typing import Annotated, Literal

from pydantic import Field, JsonValue

from .common import Open
from .fit import HeldOutSpan, JointFit
from .robots import RobotDescription

Matrix = list[list[float | None]]
PerJoint = list[float | None]
Numbers = list[float | None]
Interval = Annotated[list[float | None] | None, Field(description="ends of a 95 % interval", max_length=2)]


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
    centre: Numbers
    before: Numbers
    after: Numbers
    model: Numbers
    standard_error: Numbers
    direction: Annotated[Numbers, Field(description="1 forward motion, -1 backward motion, 0 both")]


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


class Place(Open):
    """A tenth of a joint's samples in which a generic learner predicts much of what is left."""

    coordinate: Annotated[str, Field(examples=["velocity"])]
    unit: str
    low: float
    high: float
    rms: Annotated[float, Field(description="of the prediction there, N m or N")]


class Pattern(Open):
    """What the residual of a joint still follows, though no listed cause would."""

    joint: int
    statement: str
    likelihood_ratio: Annotated[float, Field(description="rise of twice the log-likelihood")]
    log10_p: Annotated[float, Field(description="of so large a rise by luck, all patterns counted in")]


class Unexplained(Open):
    """What is left, per joint: the share a generic learner predicts, and how low noise goes."""

    joints: Annotated[list[int], Field(description="where structure is left")]
    pattern: Annotated[Pattern | None, Field(description="the clearest structure; null where there is none")]
    predictable_residual_fraction: Annotated[
        PerJoint, Field(description="null where the joint moves too little to be judged")
    ]
    interval_95: list[Interval]
    at_rest_fraction: Annotated[
        PerJoint,
        Field(description="share of the squared error that is friction at rest; null where it hardly moves"),
    ] = Field(default=[])
    rms_residual: PerJoint
    places: Annotated[list[list[Place]], Field(description="per joint, the largest first")]
    noise_floor: PerJoint
    noise_floor_source: list[Literal["repeats", "high_band", "none"]]
    noise_tilt: Annotated[
        PerJoint,
        Field(description="the noise's power density at the low over that at the high end of its band"),
    ] = Field(default=[])
    motion_period_s: Annotated[
        float | None, Field(description="after which the motion repeats; null where it does not")
    ] = None


class JointGain(Open):
    """What the cure as a whole gains on one joint, on blocks that no fit has seen."""

    joint: int
    rms_residual_before: float | None
    rms_residual_after: float | None
    improvement_percent: float | None
    interval_95: Interval
    held_out: bool


class Side(Open):
    """The model before or after the cure, fitted and held out."""

    fit: list[JointFit] = Field(default=[])
    fit_total_percent: float | None = None
    validation: list[JointFit]
    validation_total_percent: float | None = None
    base_parameters: list[dict[str, JsonValue]] = Field(default=[])
    feasible: Annotated[bool | None, Field(description="whether the extended robot can exist")] = None
    solver: dict[str, JsonValue] = Field(default={})
    model: Annotated[
        dict[str, JsonValue] | None,
        Field(description="the whole extended model, as in the file model.json of the results"),
    ] = None


class Repair(Open):
    """What a finding asks to be changed, before the log is identified or diagnosed again."""

    cause: str
    joints: list[int]
    mends: Annotated[
        Literal["robot", "log", "model", "nothing"],
        Field(description="the description, the log, the model alone (a further term), or nothing"),
    ]
    what: Annotated[str, Field(examples=["Joint 3's d in the kinematic table goes from 0.25 to 0.268 m"])]
    numbers: Annotated[dict[str, float], Field(description="what it is done with, in SI")]


class Motion(Open):
    """How far the simulated robot strays from the measured one; rows are horizons, columns joints."""

    horizons_s: list[float] = Field(default=[])
    windows: int = 0
    position_rms: Matrix = Field(default=[])
    velocity_rms: Matrix = Field(default=[])
    steady_rms: Annotated[Matrix, Field(description="of keeping the velocity")] = Field(default=[])


class Simulation(Open):
    """The model before and after the cure, made to move; empty where that was not done."""

    before: Motion
    after: Motion
    note: Annotated[
        str, Field(description="which findings are inputs to the simulation; or why there is none")
    ] = ""
    held_out: bool = True
    improvement_percent: Matrix = Field(default=[])
    improvement_total_percent: PerJoint = Field(default=[])
    interval_95: list[Interval] | None = None


class Dependence(Open):
    """What is left of one joint's residual over one coordinate, in bins."""

    coordinate: str
    joint: int
    unit: str
    centre: Numbers
    mean: Numbers
    standard_error: Numbers
    count: list[int] = Field(default=[])
    statistic: float | None
    degrees_of_freedom: int | None = None
    p_value: float | None


class Spectrum(Open):
    """Power density of what is left of one joint's residual, beside the noise floor's, (N m)^2/Hz."""

    joint: int
    frequency_hz: Numbers
    density: Numbers
    floor: Numbers


class SearchStep(Open):
    """One decision on the way to the findings."""

    action: Literal["added", "dropped", "swapped", "kept"]
    cause: str
    joints: list[int]
    statistic: Annotated[float | None, Field(description="rise of twice the log-likelihood")]


class ComparedParameter(Open):
    """A base parameter as the reference has it, and as it was identified anew."""

    name: str
    reference: float | None
    identified: float | None


class Reference(Open):
    """What the logs were compared with."""

    name: Annotated[str, Field(description="the id of a job, or prior")]
    left_open: Annotated[
        list[str],
        Field(description="base parameters of which it tells nothing: they are filled in from the logs"),
    ]
    worse_than_nothing: Annotated[
        list[int], Field(description="joints whose torque it misses by more than there is")
    ]
    base_parameters: list[ComparedParameter]


class Diagnosis(Open):
    """What the simulation gets wrong, why, what was cured, and what is left."""

    verdict: Literal["causes_found", "nothing_found", "unexplained"]
    findings: list[Finding]
    not_identifiable: list[NotIdentifiable]
    unexplained: Unexplained
    reference: Annotated[
        Reference | None, Field(description="None where everything was identified from the logs first")
    ] = None
    gain: list[JointGain]
    before: Side
    after: Side
    repairs: Annotated[list[Repair], Field(description="one per finding, in their order")] = Field(default=[])
    repaired_robot: Annotated[
        RobotDescription | None,
        Field(description="the description after its repairs, for POST /v1/robots; null where it has none"),
    ] = None
    simulation: Simulation
    atlas: list[Dependence]
    spectra: list[Spectrum] = Field(default=[])
    search: Annotated[list[SearchStep], Field(description="in the order in which it went")] = Field(
        default=[]
    )
    band_hz: Annotated[float | None, Field(description="up to where the diagnosis looked")] = None
    held_out: Annotated[
        list[HeldOutSpan],
        Field(description="what the search has not seen; the findings' own gains are of it"),
    ] = Field(default=[])
