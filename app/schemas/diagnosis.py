"""Describe the diagnosis in a result document: causes of simulation error and their correction."""

from typing import Annotated, Literal

from pydantic import Field, JsonValue

from .common import HeldOutSpan, JointFit, Open, about
from .robots import RobotDescription

Matrix = list[list[float | None]]
PerJoint = list[float | None]
Numbers = list[float | None]
Interval = Annotated[list[float | None] | None, Field(description="ends of a 95 % interval", max_length=2)]


class FoundParameter(Open):
    """A parameter of a finding with its standard deviation."""

    name: Annotated[str, Field(examples=["load_coefficient"])]
    joint: Annotated[int | None, about("null if it belongs to the whole robot")]
    unit: Annotated[str, Field(examples=["N m"])]
    value: float | None
    standard_deviation: float | None
    relative_deviation_percent: Annotated[float | None, about("%P")]


class Evidence(Open):
    """A statistic that supports the finding."""

    statement: str
    statistic: Annotated[str, Field(examples=["likelihood ratio"])]
    value: float | None


class Alternative(Open):
    """An alternative cause that was compared."""

    cause: str
    title: str
    joints: list[int]
    statistic: float | None
    why: str
    separating_experiment: Annotated[str, about("empty if the alternative was rejected")]


class Gain(Open):
    """Improvement by one finding on held-out data; lists have one entry per joint."""

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
    direction: Annotated[Numbers, about("1 forward motion, -1 backward motion, 0 both")]


class FramedPayload(Open):
    """A payload in a named frame that is fixed to its link."""

    frame: Annotated[str, Field(examples=["tool0"])]
    center_of_mass: Annotated[Numbers, about("m")]
    inertia_at_com: Annotated[Numbers, about("XX XY XZ YY YZ ZZ about the mass centre, frame's axes, kg m2")]
    paste: Annotated[dict[str, str], about("by controller: ur, abb, kuka, staubli")]


class Payload(Open):
    """The body that was attached or removed."""

    link: Annotated[int, about("counted from 1")]
    removed: bool
    mass: Annotated[float, about("kg, positive also where it was removed")]
    inertia_known: Annotated[bool, about("if not, zeros are written: a point mass")]
    flange: Annotated[
        str | None, about("the frame that is taken for the controller's; null if none is named")
    ]
    frames: list[FramedPayload]


class Finding(Open):
    """A cause with its statistics."""

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
    ambiguous_with: list[Alternative]
    refuted: list[Alternative]
    gain: Gain | None
    curve: Curve | None
    payload: Annotated[Payload | None, about("of a payload: in named frames, ready to paste")] = None


class NotIdentifiable(Open):
    """A cause that is not identifiable from this motion."""

    cause: str
    title: str
    joints: list[int]
    why: str
    separating_experiment: str


class Place(Open):
    """A tenth of a joint's samples in which a generic learner explains much of the residual."""

    coordinate: Annotated[str, Field(examples=["velocity"])]
    unit: str
    low: float
    high: float
    rms: Annotated[float, about("RMS of the prediction in that range, N m or N")]


class Pattern(Open):
    """A pattern in the residual of a joint that no known cause explains."""

    joint: int
    statement: str
    likelihood_ratio: Annotated[float, about("log-likelihood ratio statistic")]
    log10_p: Annotated[float, about("log10 of the p-value, corrected for all patterns")]


class Unexplained(Open):
    """The unexplained residual per joint: its explainable variance and the noise floor."""

    joints: Annotated[list[int], about("joints with structure in the residual")]
    pattern: Annotated[Pattern | None, about("the most significant pattern; null if there is none")]
    predictable_residual_fraction: Annotated[
        PerJoint, about("R2, upper bound; null if the joint moves too little")
    ]
    interval_95: list[Interval]
    at_rest_fraction: Annotated[
        PerJoint, about("share of the squared error due to stiction; null if the joint hardly moves")
    ] = Field(default=[])
    rms_residual: PerJoint
    places: Annotated[list[list[Place]], about("per joint, the largest first")]
    noise_floor: PerJoint
    noise_floor_source: list[Literal["repeats", "high_band", "none"]]
    noise_tilt: Annotated[
        PerJoint, about("power density of the noise at the low end of its band over that at the high end")
    ] = Field(default=[])
    motion_period_s: Annotated[float | None, about("period of the motion; null if it does not repeat")] = None


class JointGain(Open):
    """Improvement by all corrections on one joint, on held-out blocks."""

    joint: int
    rms_residual_before: float | None
    rms_residual_after: float | None
    improvement_percent: float | None
    interval_95: Interval
    held_out: bool


class Side(Open):
    """The model before or after the correction, fitted and held out."""

    fit: list[JointFit] = Field(default=[])
    fit_total_percent: float | None = None
    validation: list[JointFit]
    validation_total_percent: float | None = None
    base_parameters: list[dict[str, JsonValue]] = Field(default=[])
    feasible: Annotated[bool | None, about("whether the extended model is physically consistent")] = None
    solver: dict[str, JsonValue] = Field(default={})
    model: Annotated[
        dict[str, JsonValue] | None,
        about("the complete extended model, as in the file model.json of the results"),
    ] = None


class Repair(Open):
    """The correction for a finding, to be made before the next identification or diagnosis."""

    cause: str
    joints: list[int]
    mends: Annotated[
        Literal["robot", "log", "model", "nothing"],
        about("corrected object: robot description, log, model (a further term), or nothing"),
    ]
    what: Annotated[str, Field(examples=["Joint 3's d in the kinematic table goes from 0.25 to 0.268 m"])]
    numbers: Annotated[dict[str, float], about("values of the correction, SI units")]


class Motion(Open):
    """Error of the simulated motion; rows are horizons, columns are joints."""

    horizons_s: list[float] = Field(default=[])
    windows: int = 0
    position_rms: Matrix = Field(default=[])
    velocity_rms: Matrix = Field(default=[])
    steady_rms: Annotated[Matrix, about("error of constant velocity")] = Field(default=[])


class Simulation(Open):
    """Simulated motion of the model before and after the correction; empty if it was not simulated."""

    before: Motion
    after: Motion
    note: Annotated[str, about("findings that are simulation inputs, or why there is no simulation")] = ""
    held_out: bool = True
    improvement_percent: Matrix = Field(default=[])
    improvement_total_percent: PerJoint = Field(default=[])
    interval_95: list[Interval] | None = None


class Dependence(Open):
    """Mean residual of one joint over one coordinate, in bins."""

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
    """Power density of one joint's residual and of the noise floor, (N m)^2/Hz."""

    joint: int
    frequency_hz: Numbers
    density: Numbers
    floor: Numbers


class SearchStep(Open):
    """One decision of the stepwise search."""

    action: Literal["added", "dropped", "swapped", "kept"]
    cause: str
    joints: list[int]
    statistic: Annotated[float | None, about("log-likelihood ratio statistic")]


class ComparedParameter(Open):
    """A base parameter of the reference and as identified from the logs."""

    name: str
    reference: float | None
    identified: float | None


class Reference(Open):
    """The reference model of a diagnosis."""

    name: Annotated[str, about("the id of a job, or prior")]
    left_open: Annotated[
        list[str], about("base parameters that it does not determine; they are identified from the logs")
    ]
    worse_than_nothing: Annotated[list[int], about("joints whose torque error exceeds their RMS torque")]
    base_parameters: list[ComparedParameter]


class Diagnosis(Open):
    """Causes of simulation error, their corrections, and the unexplained residual."""

    verdict: Literal["causes_found", "nothing_found", "unexplained"]
    findings: list[Finding]
    not_identifiable: list[NotIdentifiable]
    unexplained: Unexplained
    reference: Annotated[Reference | None, about("null if the model was identified from the logs")] = None
    gain: list[JointGain]
    before: Side
    after: Side
    repairs: Annotated[list[Repair], about("corrections, one per finding, in the same order")] = Field(
        default=[]
    )
    repaired_robot: Annotated[
        RobotDescription | None, about("corrected description, for POST /v1/robots; null if there is none")
    ] = None
    simulation: Simulation
    atlas: list[Dependence]
    spectra: list[Spectrum] = Field(default=[])
    search: Annotated[list[SearchStep], about("steps in chronological order")] = Field(default=[])
    band_hz: Annotated[float | None, about("upper frequency limit of the diagnosis")] = None
    held_out: Annotated[list[HeldOutSpan], about("spans held out from the search")] = Field(default=[])
