"""Repeat an estimator's step until the torque that it predicts no longer changes.

Least squares needs one step. A criterion on simulated motion is written at the robot that was found last, the
first being that of the estimator's first equations under all constraints. Every step ends in a physically
consistent robot, so that the next one can be simulated.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..arrays import BaseParameters
from ..estimate.estimate import Estimate
from ..estimate.methods.method import Estimator, FitData, Step
from ..estimate.options import IterationOptions

Solve = Callable[[Step], Estimate]


@dataclass(frozen=True)
class Iterate:
    """Hold one step."""

    change: float
    """RMS change of the predicted torque from the robot that the equations were written at, over its RMS."""
    cost: float
    """Weighted sum of squared residuals of the step's own equations."""
    share: float
    """Share of the way to the step's estimate at which the next equations are written."""


@dataclass(frozen=True, eq=False)
class Convergence:
    """Say how an estimator ended."""

    converged: bool
    reason: str
    steps: tuple[Iterate, ...]
    """None where one step is all."""
    start: BaseParameters | None = None
    """The estimate of least squares that it began at; None where one step is all."""


ONE_STEP = Convergence(converged=True, reason="the equations are the same at any robot", steps=())


def converge(
    method: Estimator, data: FitData, solve: Solve, options: IterationOptions, tell: Callable[[float], None]
) -> tuple[Step, Estimate, Convergence]:
    """Give the last equations, their estimate, and how it came to it.

    After a step that changes the torque more than the one before, the next step is damped by half: two
    estimates may alternate. Physically consistent parameters form a convex set, so that damping leaves it
    never.

    Raises
    ------
    SolverError
        If a simulation diverges, or a programme has no accurate optimum.
    """
    first = step = method.equations(None, data)
    found = solve(step)
    if not method.iterative:
        return step, found, ONE_STEP
    steps = list[Iterate]()
    start = found.base
    at, base, share = found.standard, found.base, 1.0
    for number in range(options.most):
        tell(number / options.most)
        step = method.equations(at, data)
        found = solve(step)
        change = _relative(first, found.base - base, found.base)
        if steps and change > steps[-1].change:
            share *= 0.5
        steps.append(Iterate(change, found.objective, share))
        if change < options.tolerance:
            reason = f"the predicted torque changed by less than {options.tolerance:g} of its RMS"
            return step, found, Convergence(converged=True, reason=reason, steps=tuple(steps), start=start)
        at, base = at + share * (found.standard - at), base + share * (found.base - base)
    last = f"the last one changed the torque by {steps[-1].change:.2g} of its RMS"
    taken = "one step was" if options.most == 1 else f"{options.most} steps were"
    reason = f"{taken} taken, and {last}"
    return step, found, Convergence(converged=False, reason=reason, steps=tuple(steps), start=start)


def _relative(measured: Step, change: BaseParameters, of: BaseParameters) -> float:
    """Give the RMS of the torque that a change of the parameters makes along the log, over that of all."""
    own, whole = (float(np.linalg.norm(measured.system.triangle @ values)) for values in (change, of))
    return own / max(whole, 1e-300)
