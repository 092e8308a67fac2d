"""Give the deficit of presliding friction after a reversal: Dahl's state minus the sign of velocity.

Along the position x, df/dx = (1 - f sign(v)) / s with s the presliding distance; between reversals, over a
travel |x|, f = sign(v) + (f0 - sign(v)) exp(-|x| / s), which is exact for a reversal before friction has
built up, too. Source: Dahl, A Solid Friction Model, Aerospace Corp. TOR-0158, 1968.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...arrays import Indices, Samples, Weights
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
        runs = _runs(state, self.joint - 1)
        return [runs.friction(self.presliding_distance) - np.sign(state.velocity[:, self.joint - 1])]


@dataclass(frozen=True, eq=False)
class _Runs:
    """Hold the runs of a motion between its reversals."""

    sign: Samples
    since: Samples
    run: Indices
    """Per sample, its direction, the travel since its run began, and the run's number."""
    travels: Weights
    flips: Weights
    """Per reversal, the travel of the run that it ends, and the direction before it less that behind it."""
    missing: float
    """What friction lacks of its direction at the first sample."""

    def friction(self, distance: float) -> Samples:
        """Give the friction over its level, from -1 to 1."""
        missing = [self.missing]
        for left, flip in zip(np.exp(-self.travels / distance), self.flips, strict=True):
            missing.append(missing[-1] * left + flip)
        return np.asarray(self.sign + np.array(missing)[self.run] * np.exp(-self.since / distance))


@lru_cache(maxsize=64)
def _runs(state: MotionState, joint: int) -> _Runs:
    """Give the runs of a joint (from 0); cached for a scan."""
    return _runs_of(state.position[:, joint], state.velocity[:, joint])


def dahl(position: Samples, velocity: Samples, distance: float) -> Samples:
    """Give Dahl's friction over its level along a motion, from -1 to 1.

    Examples
    --------
    After a backward travel of ln 2 times the distance, friction is half way from 1 to -1:

    >>> dahl(np.array([0.0, 0.0, -np.log(2.0)]), np.array([1.0, -1.0, -1.0]), 1.0)
    array([1., 1., 0.])
    """
    return _runs_of(position, velocity).friction(distance)


def _runs_of(position: Samples, velocity: Samples) -> _Runs:
    sign = _last_direction(np.sign(velocity))
    travel = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(position)))])
    firsts = np.flatnonzero(np.diff(sign, prepend=0.0))
    begins = travel[firsts]
    run = np.searchsorted(firsts, np.arange(len(sign)), side="right") - 1
    resting = abs(velocity[0]) <= STANDING * np.abs(velocity).max()
    return _Runs(
        sign=sign,
        since=travel - begins[run],
        run=run,
        travels=np.diff(begins),
        flips=sign[firsts[:-1]] - sign[firsts[1:]],
        missing=-float(sign[0]) if resting else 0.0,
    )


def _last_direction(sign: Samples) -> Samples:
    """Keep the last direction of a joint at rest, forwards where it never moved."""
    moving = np.where(sign != 0.0, np.arange(len(sign)), -1)
    last = np.maximum.accumulate(moving)
    first = sign[moving >= 0][0] if (moving >= 0).any() else 1.0
    return np.asarray(np.where(last >= 0, sign[last], first))
