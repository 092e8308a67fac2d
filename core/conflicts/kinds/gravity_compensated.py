"""Test whether the torque channel holds no gravity: the drive's own compensation was subtracted from it."""

from collections.abc import Iterator

import numpy as np

from ..conflict import Conflict, Hypothesis
from ..setup import Setup
from ..trial import Trials


class GravityCompensated(Conflict):
    """Leave gravity out."""

    name = "gravity_compensated"
    title = "Torque without gravity"

    def hypotheses(self, setup: Setup, _trials: Trials) -> Iterator[Hypothesis]:
        """Set gravity to zero, where there is any."""
        if np.any(setup.robot.gravity):
            yield Hypothesis(
                self.name,
                (),
                "torque",
                setup.with_gravity(np.zeros(3)),
                "the torque holds no gravity",
                "set gravity to zero for this log, or log the whole torque",
            )
