"""Describe the traces of a result: what was measured and what the model says, instant by instant."""

from typing import Annotated

from pydantic import Field

from app.schemas.common import Open
from app.schemas.logs import Stamps

Span = Annotated[list[float], Field(min_length=2, max_length=2, description="begin and end, s")]


class ResultTrace(Open):
    """A signal of a joint, thinned for the eye; null at gaps."""

    signal: Annotated[str, Field(examples=["torque_filtered", "torque_estimated", "residual"])]
    joint: Annotated[int, Field(description="counted from 1")]
    unit: Annotated[str, Field(examples=["N m"])]
    values: Annotated[list[float | None], Field(max_length=4000)]


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
