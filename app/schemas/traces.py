"""Describe the traces of a result: what was measured and what the model says, instant by instant."""

from typing import Annotated

from pydantic import Field

from .common import Open
from .logs import Stamps

Span = Annotated[list[float], Field(min_length=2, max_length=2, description="begin and end, s")]


class ResultTrace(Open):
    """A signal of a joint, thinned for the eye; null at gaps."""

    signal: Annotated[str, Field(examples=["torque_filtered", "torque_estimated", "residual"])]
    joint: Annotated[int, Field(description="counted from 1")]
    unit: Annotated[str, Field(examples=["N m"])]
    values: Annotated[list[float | None], Field(max_length=4000)]


class ResidualCurve(Open):
    """A residual over a coordinate: per bin the mean, and what 5 and 95 of 100 instants stay below."""

    signal: Annotated[str, Field(examples=["residual"])]
    mean: list[float]
    low: list[float]
    high: list[float]


class ResidualOver(Open):
    """Residuals over one coordinate, in bins of nearly equally many instants."""

    coordinate: Annotated[str, Field(examples=["velocity"])]
    unit: str
    centre: list[float]
    curves: list[ResidualCurve]


class ResidualDensity(Open):
    """The power density of a residual, the square of its unit per Hz; empty where it never lasts long."""

    signal: str
    frequency_hz: list[float]
    density: list[float]


class ResidualViews(Open):
    """What is left of one joint's torque, over what it may depend on."""

    log: Annotated[int, Field(description="counted from 1")]
    joint: Annotated[int, Field(description="counted from 1")]
    unit: str
    samples: Annotated[int, Field(description="instants that count")]
    over: list[ResidualOver]
    densities: list[ResidualDensity]


class ResultTraces(Open):
    """Signals of one joint over a stretch of one log, on one time axis."""

    log: Annotated[int, Field(description="counted from 1")]
    joint: Annotated[int, Field(description="counted from 1")]
    extent: Annotated[Span, Field(description="first and last instant of the whole log, s")]
    rows_per_stretch: Annotated[
        int,
        Field(description="rows of which the smallest and the largest value are left; 1: every row is there"),
    ]
    time: Stamps
    traces: list[ResultTrace]
    held_out: Annotated[list[Span], Field(description="what no fit has seen")]
    left_out: Annotated[list[Span], Field(description="what does not count for this joint: standstill, ends")]
