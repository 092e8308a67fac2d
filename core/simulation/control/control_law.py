"""Hold a joint controller as the compiled loop takes it, and what it is given sample by sample."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from ...arrays import JointSeries, JointVector

PROPORTIONAL, DERIVATIVE, INTEGRAL_PLACE, INTEGRAL_RATE, LIMIT, NOW, LAST, LAST_BUT_ONE, POLE = range(9)
"""Rows of the table: gains, limit of the torque, and the speed that is seen: factors (1/s) of three positions
and of its last speed. Where all are zero the velocity itself is seen."""
LAW_ROWS = 9


@dataclass(frozen=True, eq=False)
class Gains:
    """Hold proportional and derivative gains per joint, N m/rad and N m s/rad (N/m, N s/m)."""

    stiffness: JointVector
    damping: JointVector


@dataclass(frozen=True, eq=False)
class ControlLaw:
    """Hold a controller."""

    table: np.ndarray
    """One column per joint; for its rows see `LAW_ROWS`."""
    sampled: bool
    """Whether it acts at the samples and holds its torque between them, or at every integration step."""

    @classmethod
    def of_joints(cls, gains: Gains) -> Self:
        """Pull every joint to its reference: feed-forward + kp (q_ref - q) + kd (dq_ref - dq)."""
        table = np.zeros((LAW_ROWS, len(gains.stiffness)))
        table[PROPORTIONAL], table[DERIVATIVE] = gains.stiffness, gains.damping
        table[LIMIT] = np.inf
        return cls(table, sampled=False)


@dataclass(frozen=True, eq=False)
class Inputs:
    """Hold what the controller is given at every sample."""

    feed_forward: JointSeries
    """N m or N."""
    position: JointSeries
    velocity: JointSeries
    """The reference, rad or m and per s."""
