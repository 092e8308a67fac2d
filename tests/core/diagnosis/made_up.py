"""Make up causes with whatever columns a law needs, on the second joint, so that what hides what is known."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tests.core.diagnosis.scenes import Effect
from veritorque.core.arrays import Samples
from veritorque.core.diagnosis.causes.protocol import Cause, Quantity, Scalars, SearchTraits
from veritorque.core.diagnosis.causes.shared.own_joint import NOTHING, OwnJointCause
from veritorque.core.diagnosis.search.fitter import HypothesisFitter
from veritorque.core.diagnosis.search.hypothesis import Candidate, Hypothesis
from veritorque.core.dynamics.terms.effect import OneJointTerm
from veritorque.core.robot.model import Parameter, RobotModel
from veritorque.core.signals.state import MotionState

JOINT = 2

Columns = Callable[[MotionState, Scalars], Sequence[Samples]]
"""Take a motion and a cause's scalars, give its columns on the joint, N m."""


@dataclass(frozen=True, eq=False)
class MadeUpTerm(OneJointTerm):
    """Give made-up columns."""

    make: Columns
    scalars: Mapping[str, float]
    kind = "made_up"

    def parameters(self, robot: RobotModel) -> tuple[Parameter, ...]:
        count = len(self.make(NO_MOTION, self.scalars))
        return tuple(Parameter(f"c{place}", self.joint, self.joint, "1", None) for place in range(count))

    def columns(self, state: MotionState) -> list[Samples]:
        return list(self.make(state, self.scalars))


class MadeUpCause(OwnJointCause):
    """Candidate cause: made-up columns; some of its scalars are admissible."""

    make: Columns
    points: Sequence[Scalars]
    allowed: Callable[[Scalars], bool]
    units = ()
    experiment = "any other motion"

    def sites(self, dataset):
        return [(JOINT,)]

    def grid(self, at):
        return self.points

    def term(self, at):
        return MadeUpTerm(at.joint, type(self).make, at.scalars)

    def admissible(self, solved):
        return type(self).allowed(solved.scalars)

    def quantities(self, solved):
        deviations = np.sqrt(np.diag(solved.covariance))
        return tuple(
            Quantity(f"size_{place}", JOINT, "1", float(value), float(deviation))
            for place, (value, deviation) in enumerate(zip(solved.values, deviations, strict=True))
        )

    def statement(self, solved):
        return f"Joint {solved.site[0]} does as made up"


def made_up(
    name: str,
    make: Columns,
    points: Sequence[Scalars] = NOTHING,
    *,
    allowed: Callable[[Scalars], bool] = lambda scalars: True,
    like_position_noise: bool = False,
    transient: bool = False,
) -> MadeUpCause:
    """Make up a cause of a given name."""
    own = {"id": name, "title": name, "make": make, "points": points, "allowed": allowed}
    own |= {"traits": SearchTraits(transient=transient, like_position_noise=like_position_noise)}
    return type(name, (MadeUpCause,), own)()


NO_MOTION = MotionState(*(np.zeros((2, 3)) for _ in range(3)), time=np.array([0.0, 1.0]))


def on_joint(torque: Callable[[MotionState], Samples]) -> Effect:
    """Put a torque on the joint and none on the others."""

    def effect(state: MotionState) -> np.ndarray:
        out = np.zeros_like(state.position)
        out[:, JOINT - 1] = torque(state)
        return out

    return effect


def candidate(cause: Cause, scalars: Scalars | None = None) -> Candidate:
    """Name a made-up cause on its joint."""
    return Candidate(cause, (JOINT,), scalars or {}, 1.0)


def nothing_found(fitter: HypothesisFitter) -> Hypothesis:
    """Fit the model alone."""
    return fitter.fit(())
