"""Hold some of a model's terms together with their parameters."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import JointSeries, Parameters, Weights
from ..dynamics.model import DynamicModel
from ..dynamics.term import Term
from ..robot.model import RobotModel
from ..signals.state import MotionState


@dataclass(frozen=True, eq=False)
class Share:
    """Hold terms as a model of their own, and their parameters."""

    model: DynamicModel
    parameters: Parameters

    @property
    def names(self) -> tuple[str, ...]:
        """Name the terms."""
        return tuple(term.name for term in self.model.terms)

    def torque(self, state: MotionState) -> JointSeries:
        """Give the torque (N m or N) of these terms alone."""
        return self.model.torque(self.parameters, state)


def share_of(robot: RobotModel, parts: Sequence[tuple[Term, Weights]]) -> Share:
    """Put terms together."""
    model = DynamicModel(robot, tuple(term for term, _ in parts))
    return Share(model, np.concatenate([np.zeros(0), *(values for _, values in parts)]))
