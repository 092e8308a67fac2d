"""Model forces that follow positions and that no robot's model has, such as a hose's or a spring's."""

from dataclasses import dataclass

import numpy as np

from ..arrays import JointVector, Series
from ..dynamics.term import Entry, Term
from ..robot.joint_units import joint_unit
from ..robot.model import Parameter, RobotModel
from ..signals.state import MotionState
from .samples import Samples
from .setup import Setup
from .thresholds import POSITION_FORCES
from .trial import Trials


@dataclass(frozen=True, eq=False)
class PositionForces(Term):
    """Model smooth functions of a joint's position and of its neighbours', as a line and half cosine waves.

    A cosine series of such a function converges whatever it is at both ends. Source: Boyd, Chebyshev and
    Fourier Spectral Methods (2001), ch. 2.
    """

    least: JointVector
    """Least position of every joint, rad or m."""
    span: JointVector
    """By how much each moves, rad or m."""
    waves: bool = True
    """Whether there are waves; a spring at every joint is left without."""
    name: str = "position_forces"

    @classmethod
    def over(cls, samples: Samples, *, waves: bool = True) -> "PositionForces":
        """Take the range that the joints move in."""
        least = samples.position.min(axis=0)
        return cls(least, samples.position.max(axis=0) - least, waves)

    def parameters(self, robot: RobotModel) -> tuple[Parameter, ...]:
        """List the coefficients, in N m (N)."""
        return tuple(
            Parameter(
                f"P{other + 1}_{order}_", joint + 1, joint + 1, joint_unit(robot, joint + 1, "N m"), None
            )
            for joint, other, order in self._shapes()
        )

    def entries(self, _robot: RobotModel) -> tuple[Entry, ...]:
        """Put each on its joint."""
        return tuple((joint, place) for place, (joint, _, _) in enumerate(self._shapes()))

    def series(self, _robot: RobotModel, state: MotionState) -> Series:
        """Give the functions of the positions."""
        share = (state.position - self.least) / np.where(self.span > 0.0, self.span, 1.0)
        return np.array(
            [
                np.cos(np.pi * order * share[:, other]) if order else share[:, other]
                for _, other, order in self._shapes()
            ]
        ).reshape(-1, len(share))

    def _shapes(self) -> list[tuple[int, int, int]]:
        """List joint and joint whose position it follows, both from 0, and half waves; none for the line."""
        joints = len(self.span)
        return [
            (joint, other, order)
            for joint in range(joints)
            for other in range(max(joint - 1, 0), min(joint + 2, joints))
            for order in range(self._orders(joint, other))
            if self.span[other] > POSITION_FORCES.least_span
        ]

    def _orders(self, joint: int, other: int) -> int:
        """Count the shapes of a joint's force over another's position, or its own."""
        if not self.waves:
            return int(joint == other)
        return 1 + (POSITION_FORCES.own if other == joint else POSITION_FORCES.neighbour)


def beside_forces(trials: Trials, setup: Setup, *, waves: bool = True) -> Trials:
    """Give trials on the same samples whose model has such forces, or springs alone."""
    forces = PositionForces.over(trials.samples.moved(setup.assignment), waves=waves)
    return Trials(trials.samples, trials.terms, beside=(forces,))
