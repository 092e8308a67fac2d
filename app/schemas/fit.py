"""Describe torque prediction errors and held-out spans."""

from typing import Annotated

from pydantic import Field

from .common import Open


class JointFit(Open):
    """Torque prediction error of a joint."""

    joint: int
    samples: int = 0
    rms_torque: float
    rms_residual: float
    nrmse_of_range_percent: float | None
    nrmse_of_rms_percent: float | None


class HeldOutSpan(Open):
    """A held-out span of a log."""

    log: Annotated[int, Field(description="counted from 1")]
    begin_s: float
    end_s: float
