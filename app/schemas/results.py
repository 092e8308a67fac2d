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


class EstimationStep(Open):
    """One step of an iterative estimator."""

    change: Annotated[float, about("RMS change of the predicted torque, as a share of its RMS")]
    cost: Annotated[float, about("weighted sum of squared residuals of the step's equations")]
    share: Annotated[float, about("of the way to this estimate, where the next equations are written")]


class Instruments(Open):
    """What instruments tell of errors in the measured motion."""

    statistic: Annotated[float, about("chi-square statistic of the difference to least squares")]
    degrees: int
    p_value: Annotated[float, about("of columns without errors: small where least squares is biased")]
    largest: Annotated[float, about("largest difference of a parameter, in deviations of least squares")]
    weakest: Annotated[float, about("least canonical correlation of instruments and columns, 0 to 1")]


class Attenuation(Open):
    """What noise of positions makes of the inertias that least squares finds."""

    inertia_percent: Annotated[
        list[float | None],
        about("per joint: what least squares misses of its inertia; negative if it finds too much"),
    ]
    position_noise: Annotated[list[float], about("per joint: white noise of its positions, RMS, rad or m")]
    cutoff_hz: Annotated[float, about("of the parallel filter; the widest of all logs")]


class Innovations(Open):
    """What a Kalman filter assumed, and how well it foresaw the positions."""

    position_noise: Annotated[list[float], about("deviation per joint that it assumed, rad or m")]
    torque_noise: Annotated[list[float], about("the same of the filtered torque, N m or N")]
    variance: Annotated[list[float], about("of what was not foreseen, over what was expected, per joint")]
    shortened: Annotated[float, about("share of samples at which parameters had to differ by less")]
    dispersion: Annotated[float, about("factor on variances by which blocks scatter more than expected")]
    start_scale: Annotated[float, about("factor on the first fit's deviations with which the filter began")]


class OverTime(Open):
    """The base parameters over time, at the ends of the fitted blocks."""

    log: Annotated[list[int], about("number of the log at every instant, from 1")]
    time: Annotated[list[float], about("s")]
    value: Annotated[list[list[float]], about("per instant, in the order of the base parameters")]
    standard_deviation: Annotated[list[list[float]], about("per instant, with what blocks scatter")]


class SpringQuantity(Open):
    """A number of a flexible joint."""

    name: Annotated[
        Literal["stiffness", "damping", "motor_inertia", "link_inertia", "antiresonance", "natural"],
        about(
            "`natural`: motor and link against each other; `antiresonance`: the link alone, motor held; both "
            "with the link's median inertia over the motion"
        ),
    ]
    value: float
    unit: str
    standard_deviation: float
    relative_deviation_percent: float | None
    interval_95: Annotated[list[float], Field(min_length=2, max_length=2)]


class FlexibleJoint(Open):
    """What is known of a spring between motor and link."""

    joint: int
    quantities: list[SpringQuantity]
    evidence: Annotated[dict[str, float | None], about("the numbers by which the logs show the spring")]


class Estimation(Open):
    """By which estimator a robot was fitted, and how it ended."""

    estimator: str
    title: str
    statements: Annotated[list[str], about("the same in sentences")]
    choice: Annotated[
        dict[str, str] | None, about("which estimator was chosen and why; null where one was asked for")
    ]
    constrained: Annotated[bool, about("whether every step is solved under the constraints of consistency")]
    converged: bool
    stop_reason: str
    steps: Annotated[list[EstimationStep], about("empty where the equations are the same at any robot")]
    start_error_percent: Annotated[
        float | None,
        about(
            "torque error of the least squares it began at, on held-out data if any; null without iteration"
        ),
    ] = None
    simulation: Annotated[
        dict[str, JsonValue] | None, about("how the logs were replayed; null where nothing is simulated")
    ]
    instruments: Instruments | None
    attenuation: Attenuation | None = None
    innovations: Annotated[Innovations | None, about("null where no filter was used")] = None
    over_time: Annotated[OverTime | None, about("null where parameters were not followed")] = None
    flexible_joints: Annotated[
        list[FlexibleJoint], about("those of the option of that name; empty where all joints are rigid")
    ] = Field(default=[])


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
    estimation: Estimation | None = None
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
    estimation: Estimation | None = None
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
