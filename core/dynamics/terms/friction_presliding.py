"""Give the deficit of presliding friction after a reversal: Dahl's state minus the sign of velocity.

Along the position x, df/dx = (1 - f sign(v)) / s with s the presliding distance; between reversals, over a
travel |x|, f = sign(v) + (f0 - sign(v)) exp(-|x| / s), which is exact for a reversal before friction has
built up, too. Source: Dahl, A Solid Friction Model, Aerospace Corp. TOR-0158, 1968.
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import Samples
from ...signals.state import MotionState
from .effect import OneJointTerm

STANDING = 0.01
"""Share of its largest speed below which a joint is at rest when a stretch begins."""


@dataclass(frozen=True, eq=False)
class Presliding(OneJointTerm):
    """Model friction that builds up over `presliding_distance`, rad (m), to the given level.

    Nothing is known before a stretch: friction is taken as built up where the joint moves at the start of the
    stretch, and as zero where it is at rest.
    """

    presliding_distance: float
    symbols = (("coulomb_level", "N m", 0.0),)
    kind = "friction_presliding"
    has_memory = True

    def columns(self, state: MotionState) -> list[Samples]:
        """Give Dahl's state minus sign(v)."""
        own = self.joint - 1
        position, velocity = state.position[:, own], state.velocity[:, own]
        return [dahl(position, velocity, self.presliding_distance) - np.sign(velocity)]


def dahl(position: Samples, velocity: Samples, distance: float) -> Samples:
    """Give Dahl's friction over its level along a motion, from -1 to 1.

    Examples
    --------
    After a backward travel of ln 2 times the distance, friction is half way from 1 to -1:

    >>> dahl(np.array([0.0, 0.0, -np.log(2.0)]), np.array([1.0, -1.0, -1.0]), 1.0)
    array([1., 1., 0.])
    """
    sign = _last_direction(np.sign(velocity))
    travel = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(position)))])
    firsts = np.flatnonzero(np.diff(sign, prepend=0.0))
    begins = travel[firsts]
    missing = np.zeros(len(firsts))
    if abs(velocity[0]) <= STANDING * np.abs(velocity).max():
        missing[0] = -sign[0]
    for turn in range(1, len(firsts)):
        left = missing[turn - 1] * np.exp(-(begins[turn] - begins[turn - 1]) / distance)
        missing[turn] = left + sign[firsts[turn - 1]] - sign[firsts[turn]]
    run = np.searchsorted(firsts, np.arange(len(sign)), side="right") - 1
    return np.asarray(sign + missing[run] * np.exp(-(travel - begins[run]) / distance))


def _last_direction(sign: Samples) -> Samples:
    """Keep the last direction of a joint at rest, forwards where it never moved."""
    moving = np.where(sign != 0.0, np.arange(len(sign)), -1)
    last = np.maximum.accumulate(moving)
    first = sign[moving >= 0][0] if (moving >= 0).any() else 1.0
    return np.asarray(np.where(last >= 0, sign[last], first))
