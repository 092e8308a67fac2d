"""Test whether the torque holds little or no gravity: a controller's own compensation was subtracted from it.

A first moment gives a torque at rest and, by the motion, another one. Both together tell how much of gravity
a torque holds, whatever the moments are.
"""

from collections.abc import Iterator

import numpy as np

from ..conflict import Conflict, Hypothesis
from ..path import Margins
from ..setup import Setup
from ..thresholds import COMPENSATION
from ..trial import Trials


class GravityCompensated(Conflict):
    """Leave out the most of gravity."""

    name = "gravity_compensated"
    title = "Torque without gravity"
    spoils = frozenset({"friction_position_dependent", "friction_load_dependent"})
    """Gears transmit the load that such a torque does not hold: its friction follows the position."""

    def hypotheses(self, setup: Setup, trials: Trials) -> Iterator[Hypothesis]:
        """Give the likeliest share of gravity that is left, where there is gravity.

        It is significant where least squares fits so much better.
        """
        described = np.asarray(setup.robot.gravity, dtype=float)
        if not np.any(described):
            return
        bound = trials.under_gravity(setup)
        shares = np.linspace(-COMPENSATION.most, COMPENSATION.most, COMPENSATION.steps)
        scores = bound(shares[:, None] * described)
        margins = Margins(trials.samples.independent * len(setup.robot.joints))
        none, best = int(np.argmin(np.abs(shares))), int(np.argmin(scores))
        best = none if scores[none] <= scores[best] + margins.equal else best
        gravity = shares[best] * described
        listed = ", ".join(f"{component + 0.0:.3g}" for component in gravity)
        yield Hypothesis(
            self.name,
            (),
            "torque",
            setup.with_gravity(gravity),
            _statement(shares[best]),
            f"set gravity to [{listed}] m/s2 for this log, or log the whole torque",
            is_significant=bool(scores[best] < bound(described) - margins.undecided),
        )


def _statement(share: float) -> str:
    if share < 0.0:
        return f"{100.0 * (1.0 - share):.0f} % of gravity was taken from the torque, more than all of it"
    return f"the torque holds {100.0 * share:.0f} % of gravity" if share else "the torque holds no gravity"
