"""Test whether a torque is off by a factor that is no unit's: a gear ratio, or a wrong torque constant."""

from collections.abc import Iterator

import numpy as np
from scipy.optimize import minimize_scalar

from ..conflict import Conflict, Hypothesis
from ..normal import Normal
from ..setup import Setup
from ..thresholds import RATIO
from ..trial import Trials


class GearRatio(Conflict):
    """Multiply the torque of one joint by the factor that the torques of the others ask for."""

    name = "gear_ratio"
    title = "Gear ratio of a torque"

    def hypotheses(self, setup: Setup, trials: Trials) -> Iterator[Hypothesis]:
        """Give the likeliest factor of every torque, where it is more than a gain's error."""
        normal = trials.equations(setup).normal
        for joint in range(setup.joints):
            linear = normal.linear_factor(joint)
            firsts = (*RATIO.coarse, *(() if linear is None else (linear,)))
            bounds = [normal.with_factor(joint, factor).bound for factor in firsts]
            if normal.bound - min(bounds) < RATIO.promising:
                continue
            factor = _likeliest(normal, joint, firsts[int(np.argmin(bounds))])
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
    return _likeliest(trials.equations(setup).normal, joint, 1.0)


def _likeliest(normal: Normal, joint: int, first: float) -> float:
    """Refine a factor from a first one."""

    def bound(logarithm: float) -> float:
        return normal.with_factor(joint, float(np.exp(logarithm))).bound

    around = np.log(first) + np.array([-RATIO.around, RATIO.around])
    found = minimize_scalar(bound, bounds=around, method="bounded", options={"xatol": RATIO.tolerance})
    return float(np.exp(found.x))


def with_factor(setup: Setup, joint: int, factor: float) -> Setup:
    """Multiply the torque of a joint (from 0)."""
    return setup.with_torque(setup.assignment.torque.scaled(factor, joint))
