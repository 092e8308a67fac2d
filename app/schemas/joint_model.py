"""Describe the document of one joint's continuous-time model."""

from typing import Annotated, Literal

from pydantic import Field, JsonValue

from .common import HeldOutSpan, Open, about
from .conflicts import Conflict


class JointParameter(Open):
    """A quantity of the joint's model."""

    name: Annotated[str, Field(examples=["stiffness"])]
    symbol: Annotated[str, Field(examples=["k"])]
    unit: Annotated[str, about("SI, of the joint's type"), Field(examples=["N m/rad"])]
    value: float
    standard_deviation: float
    relative_deviation_percent: Annotated[float | None, about("%P; null where the value is zero")]
    interval_95: Annotated[list[float], Field(min_length=2, max_length=2)]


class JointFailure(Open):
    """Why a model of this order is no answer."""

    cause: str
    evidence: dict[str, JsonValue]
    remedy: str


class JointStep(Open):
    """One step of the instrumental variables."""

    change: Annotated[float, about("largest change of a coefficient, as a share of it or its deviation")]
    innovation: Annotated[float, about("RMS of the innovations, rad or m")]


class OrderModel(Open):
    """The model of one order."""

    order: Literal["rigid", "flexible"]
    failure: Annotated[JointFailure | None, about("null where the model is an answer")]
    parameters: Annotated[list[JointParameter], about("empty after a failure")]
    frequencies: Annotated[
        list[JointParameter],
        about("`natural`: motor and link against each other; `antiresonance`: the link alone, motor held"),
    ]
    torque_error_percent: Annotated[
        float | None,
        about("RMS error of the torque below `crossover_hz`, % of that torque, on held-out rows"),
    ]
    torque_error_fitted_percent: Annotated[float | None, about("the same on fitted rows")]
    simulated_position_rms: Annotated[
        float | None,
        about("RMS error of the position simulated under the log's controller, on held-out rows, rad or m"),
    ]
    simulated_position_percent: Annotated[float | None, about("the same, % of the motion's RMS")]
    crossover_hz: Annotated[float | None, about("below it noise of the torque outweighs that of positions")]
    torque_late_s: Annotated[
        float | None,
        about(
            "by how much later than it acted the torque stands in the log, s, to first order; a warning"
            " follows where it is more than half a sample by three deviations"
        ),
    ]
    torque_late_deviation_s: Annotated[float | None, about("its standard deviation, s")]
    converged: bool
    steps: list[JointStep]


class Flexibility(Open):
    """Whether the log shows that the joint is flexible."""

    seen: Annotated[bool | None, about("null where the flexible model was not asked for")]
    statement: str
    evidence: Annotated[
        dict[str, float | None], about("the numbers that decided; empty where no flexible model was possible")
    ]


class ModelResponse(Open):
    """The gain of a model."""

    order: Literal["rigid", "flexible"]
    gain: list[float | None]


class FrequencyResponse(Open):
    """Gains from torque to position over frequency."""

    unit: str
    frequency_hz: list[float]
    measured: list[float | None]
    coherence: Annotated[list[float | None], about("share of the position's power that the torque explains")]
    models: list[ModelResponse]


class RecognisedController(Open):
    """The log's controller, at this joint."""

    kind: Literal["pd", "cascade"]
    velocity: str
    cutoff_hz: float | None
    delay_samples: int
    feed_forward: bool
    kp: float
    kd: float
    ki: float | None
    torque_gain: float | None
    saturation: float | None
    channel: str
    command_residual_percent: Annotated[float, about("RMS of recomputed less logged command, % of it")]


class JointData(Open):
    """The rows that were used."""

    begin_s: float
    end_s: float
    rate_hz: float
    samples: int
    held_out: list[HeldOutSpan]
    standing_percent: Annotated[float, about("of the rows, in which friction holds the joint")]
    gravity: Annotated[bool, about("whether the model has torques by sine and cosine of the position")]
    travels: Annotated[list[float], about("of every joint, rad or m")]
    travels_allowed: Annotated[
        list[float | None], about("travel up to which another joint stands; null for the joint itself")
    ]


class JointModelDocument(Open):
    """The continuous-time model of one joint."""

    schema_version: str
    kind: Literal["joint_model"]
    conflicts: list[Conflict]
    doubts: Annotated[list[str], about("warnings, as sentences")]
    robot: dict[str, JsonValue]
    logs: list[dict[str, JsonValue]]
    provenance: dict[str, JsonValue]
    joint: Annotated[int, about("counted from 1")]
    joint_type: Literal["revolute", "prismatic"]
    order: Annotated[Literal["rigid", "flexible"], about("as asked")]
    estimator: Literal["srivc", "clsrivc"]
    estimator_title: str
    flexibility: Flexibility
    models: list[OrderModel]
    response: FrequencyResponse
    controller: Annotated[RecognisedController | None, about("null for `srivc`")]
    data: JointData
    defects: list[JsonValue]
