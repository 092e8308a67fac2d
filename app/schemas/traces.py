"""Describe the traces of a result: measured and modelled signals at every sample."""

from typing import Annotated

from pydantic import Field

from .common import Open, about
from .logs import Stamps

Span = Annotated[list[float], Field(min_length=2, max_length=2, description="begin and end, s")]


class ResultTrace(Open):
    """A signal of a joint, min/max decimated; null at gaps."""

    signal: Annotated[str, Field(examples=["torque_filtered", "torque_estimated", "residual"])]
    joint: Annotated[int, about("counted from 1")]
    unit: Annotated[str, Field(examples=["N m"])]
    values: Annotated[list[float | None], Field(max_length=4000)]


class ResidualCurve(Open):
    """A residual over a coordinate: mean, 5 % and 95 % quantile per bin."""

    signal: Annotated[str, Field(examples=["residual"])]
    mean: list[float]
    low: list[float]
    high: list[float]


class ResidualOver(Open):
    """Residuals over one coordinate, in bins with nearly equal counts."""

    coordinate: Annotated[str, Field(examples=["velocity"])]
    unit: str
    centre: list[float]
    curves: list[ResidualCurve]


class ResidualDensity(Open):
    """Power density of a residual, the square of its unit per Hz; empty if no segment is long enough."""

    signal: str
    frequency_hz: list[float]
    density: list[float]


class ResidualViews(Open):
    """The residual of one joint over coordinates and frequency."""

    log: Annotated[int, about("counted from 1")]
    joint: Annotated[int, about("counted from 1")]
    unit: str
    samples: Annotated[int, about("number of samples used")]
    over: list[ResidualOver]
    densities: list[ResidualDensity]


class ResultTraces(Open):
    """Signals of one joint over a span of one log, on one time axis."""

    log: Annotated[int, about("counted from 1")]
    joint: Annotated[int, about("counted from 1")]
    extent: Annotated[Span, about("first and last time stamp of the log, s")]
    rows_per_stretch: Annotated[
        int, about("rows per decimation group (minimum and maximum); 1 without decimation")
    ]
    time: Stamps
    traces: list[ResultTrace]
    held_out: Annotated[list[Span], about("held-out spans")]
    left_out: Annotated[list[Span], about("spans not used for this joint: standstill, ends")]
