"""Test whether a torque or positions are off by a factor that is no unit's, as a gear ratio or a constant."""

from collections.abc import Iterator

import numpy as np
from scipy.optimize import minimize_scalar

from ..conflict import Conflict, Hypothesis
from ..reduced import Reduced
from ..setup import Setup
from ..thresholds import RATIO
from ..trial import Trials
from .position_ratio import position_hypotheses


class GearRatio(Conflict):
    """Multiply torques or positions by the factors that the other channels ask for."""

    name = "gear_ratio"
    title = "Gear ratio of a channel"
    doubtful_causes = frozenset({"torque_gain"})
    """Gains are relative: whichever joint one is found on, it may be the estimated factor's error."""

    def hypotheses(self, setup: Setup, trials: Trials) -> Iterator[Hypothesis]:
        """Give the likeliest factor of every torque, if it is more than a gain's error, and of positions."""
        present = trials.equations(setup).reduced
        for joint in range(setup.joints):
            linear = present.linear_factor(joint)
            firsts = np.array([*RATIO.coarse, *(() if linear is None else (linear,))])
            bounds = present.with_factors(joint, firsts).bound
            if present.bound - bounds.min() < RATIO.promising:
                continue
            factor = _likeliest(present, joint, float(firsts[np.argmin(bounds)]))
            if RATIO.least <= abs(np.log(factor)) <= RATIO.most:
                yield factor_hypothesis(setup, joint, factor)
        yield from position_hypotheses(self.name, setup, trials)


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
    return _likeliest(trials.equations(setup).reduced, joint, 1.0)


def _likeliest(present: Reduced, joint: int, first: float) -> float:
    """Refine a factor from a first one."""

    def bound(logarithm: float) -> float:
        return float(present.with_factors(joint, np.exp([logarithm])).bound[0])

    around = np.log(first) + np.array([-RATIO.around, RATIO.around])
    found = minimize_scalar(bound, bounds=around, method="bounded", options={"xatol": RATIO.tolerance})
    return float(np.exp(found.x))


def with_factor(setup: Setup, joint: int, factor: float) -> Setup:
    """Multiply the torque of a joint (from 0)."""
    return setup.with_torque(setup.assignment.torque.scaled(factor, joint))
