"""Choose the estimator of a log: least squares, unless noise of its positions biases what that finds.

Where the noise attenuates an inertia by more than a warning allows, the robot is fitted to its simulated
motion instead, which holds no noisy column. It is preferred if it predicts held-out motion no worse: the
error of held-out torque cannot judge, because biased parameters predict it best from noisy columns.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, TypeVar, runtime_checkable

import numpy as np

from ..errors import LogError, OptionError, SolverError
from ..estimate.estimate import Estimate
from ..estimate.problem import Problem
from ..precision.attenuation import Attenuation
from ..simulation.mechanism import mechanism_of

USUAL, SPARED = "sdp", "cloe"
"""The estimator for usual noise, and the one for more. On simulated arms with encoders of 0.1 degrees the
second one's torque errs by about a third of what the first one's does."""
BIASED = 0.01
"""Share of an inertia that noise may take from it. On simulated arms least squares errs about four times as
much as instrumental variables from there on."""


@runtime_checkable
class Fitted(Protocol):
    """Hold a fit."""

    @property
    def estimate(self) -> Estimate:
        """Give its estimate."""


Answer = TypeVar("Answer", bound=Fitted)


@dataclass(frozen=True)
class Choice:
    """Say which estimator was chosen, and why."""

    estimator: str
    reason: str


def choose(
    problem: Problem, least: Answer, noise: Attenuation, spared: Callable[[], Answer]
) -> tuple[Answer, Choice]:
    """Choose between two fits, the second of which is made only where it may be needed.

    Parameters
    ----------
    least
        The fit by least squares.
    noise
        What noise of positions makes of its inertias.
    spared
        Fits the simulated motion.
    """
    shares = np.nan_to_num(np.abs(noise.missed))
    joint, worst = int(np.argmax(shares)), 100.0 * float(shares.max(initial=0.0))
    if worst <= 100.0 * BIASED:
        return least, Choice(USUAL, f"noise of positions attenuates no inertia by more than {worst:.2g} %")
    why = f"noise of positions attenuates the inertia of joint {joint + 1} by about {worst:.2g} %"
    try:
        other = spared()
        gain = _gain(problem, least.estimate, other.estimate)
    except (LogError, OptionError, SolverError) as error:
        return least, Choice(USUAL, f"{why}, but the log cannot be simulated: {error.cause}")
    if gain < 0.0:
        return least, Choice(
            USUAL, f"{why}, but simulated motion fits no better: its error rises by {-gain:.2g} %"
        )
    return other, Choice(SPARED, f"{why}; simulated motion errs {gain:.2g} % less than by least squares")


def _gain(problem: Problem, before: Estimate, after: Estimate) -> float:
    """Give by how much errors of simulated motion on held-out blocks fall, %, the mean over joints."""
    from ..simulation.multistep import compare  # compiled

    old, new = (mechanism_of(problem.base.model, one.standard) for one in (before, after))
    compared = compare(old, new, problem.motions, chosen=problem.held_out or None)
    return float(np.mean(compared.total_gain_percent))
