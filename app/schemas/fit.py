"""Describe how well a model predicts torque, and on what no fit has seen."""

from typing import Annotated

from pydantic import Field

from .common import Open


class JointFit(Open):
    """How well the model predicts the torque of a joint."""

    joint: int
    samples: int = 0
    rms_torque: float
    rms_residual: float
    nrmse_of_range_percent: float | None
    nrmse_of_rms_percent: float | None


class HeldOutSpan(Open):
    """A stretch of a log that no fit has seen."""

    log: Annotated[int, Field(description="counted from 1")]
    begin_s: float
    end_s: float
