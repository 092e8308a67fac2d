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
            first = _promising(setup, trials, joint)
            if first is None:
                continue
            factor = first * likeliest_factor(with_factor(setup, joint, first), trials, joint)
            if abs(np.log(factor)) >= RATIO.least:
                yield factor_hypothesis(setup, joint, factor)


def factor_hypothesis(setup: Setup, joint: int, factor: float) -> Hypothesis:
    """Say that the torque of a joint (from 0) has to be multiplied by a factor."""
    times, said = (factor, "smaller") if factor > 1.0 else (1.0 / factor, "larger")
    return Hypothesis(
        GearRatio.name,
        (joint + 1,),
        "torque",
        with_factor(setup, joint, factor),
        f"the torque of joint {joint + 1} is about {times:.3g} times {said} than the other torques "
        "and the motion require, as on the motor's side of a gear",
        f"read the torque of joint {joint + 1} with the scale {factor:.4g}, or the exact ratio",
    )


def likeliest_factor(setup: Setup, trials: Trials, joint: int) -> float:
    """Minimise what least squares leaves over a factor on the torque of a joint (from 0)."""

    def bound(logarithm: float) -> float:
        return _bound(with_factor(setup, joint, float(np.exp(logarithm))), trials)

    around = -RATIO.around, RATIO.around
    found = minimize_scalar(bound, bounds=around, method="bounded", options={"xatol": RATIO.tolerance})
    return float(np.exp(found.x))


def with_factor(setup: Setup, joint: int, factor: float) -> Setup:
    """Multiply the torque of a joint (from 0)."""
    return setup.with_torque(setup.assignment.torque.scaled(factor, joint))


def _promising(setup: Setup, trials: Trials, joint: int) -> float | None:
    """Give the first estimate, which is linear: the noise of the torque makes it too small."""
    first = trials.equations(setup).normal.likeliest_factor(joint)
    if first is None:
        return None
    fall = _bound(setup, trials) - _bound(with_factor(setup, joint, first), trials)
    return first if fall >= RATIO.promising else None


def _bound(setup: Setup, trials: Trials) -> float:
    return trials.equations(setup).normal.bound
