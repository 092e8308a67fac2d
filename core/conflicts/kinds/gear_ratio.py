"""Test whether a torque is off by a factor that is no unit's: a gear ratio, or a wrong torque constant."""

from collections.abc import Iterator

import numpy as np
from scipy.optimize import minimize_scalar

from ..conflict import Conflict, Hypothesis
from ..setup import Setup
from ..thresholds import RATIO
from ..trial import Trials


class GearRatio(Conflict):
    """Multiply the torque of one joint by the factor that the torques of the others ask for."""

    name = "gear_ratio"
    title = "Gear ratio of a torque"

    def hypotheses(self, setup: Setup, trials: Trials) -> Iterator[Hypothesis]:
        """Give the likeliest factor of every torque, where it is more than a gain's error."""
        for joint in range(setup.joints):
            factor = _likeliest(setup, trials, joint)
            if factor is None or abs(np.log(factor)) < RATIO.least:
                continue
            times, said = (factor, "smaller") if factor > 1.0 else (1.0 / factor, "larger")
            yield Hypothesis(
                self.name,
                (joint + 1,),
                "torque",
                _scaled(setup, joint, factor),
                f"the torque of joint {joint + 1} is about {times:.3g} times {said} than the other torques "
                "and the motion require, as on the motor's side of a gear",
                f"read the torque of joint {joint + 1} with the scale {factor:.4g}, or the exact ratio",
            )


def _likeliest(setup: Setup, trials: Trials, joint: int) -> float | None:
    """Minimise what least squares leaves over the factor; None where none is promising.

    The first estimate is linear. The noise of the torque makes it too small.
    """
    normal = trials.equations(setup).normal
    first = normal.likeliest_factor(joint)
    if first is None:
        return None

    def bound(logarithm: float) -> float:
        return trials.equations(_scaled(setup, joint, float(np.exp(logarithm)))).normal.bound

    middle = np.log(first)
    if normal.bound - bound(middle) < RATIO.promising:
        return None
    around = middle - RATIO.around, middle + RATIO.around
    found = minimize_scalar(bound, bounds=around, method="bounded", options={"xatol": RATIO.tolerance})
    return float(np.exp(found.x))


def _scaled(setup: Setup, joint: int, factor: float) -> Setup:
    return setup.with_torque(setup.assignment.torque.scaled(factor, joint))
