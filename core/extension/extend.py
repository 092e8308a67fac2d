"""Extend a model by the causes that were found, and verify by identification those whose gain is in doubt."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

from ..diagnosis.result import Diagnosis
from ..estimate.problem import Problem
from ..identification.identify import Fit, fit
from ..identification.options import IdentifyOptions
from ..regressor.observe import Observation
from .cure import as_verified, corrections, extended_base, global_indices, sizes
from .gain import JointGain, gains
from .verification import verify


def extend(found: Diagnosis, problem: Problem) -> Problem:
    """Add the causes whose gain is significant or verified to the model."""
    return replace(problem, base=extended_base(problem.base, corrections(found)), sizes=sizes(found))


def verified(
    found: Diagnosis, options: IdentifyOptions, problem: Problem, tell: Callable[[], None]
) -> tuple[Diagnosis, Fit | None]:
    """Identify again with causes whose gain the search leaves in doubt; give the last such fit if any.

    Parameters
    ----------
    tell
        Called again and again meanwhile.
    """

    @cache
    def observed() -> Observation:
        return extend(as_verified(found), problem).observed(lambda _done: tell())

    def tried(trial: Diagnosis) -> Fit:
        joined = extend(trial, problem)
        seen = observed().over(joined.plan, global_indices(trial, problem.base))
        return fit(joined, options, lambda _stage, _done: tell(), seen)

    def gained(*fits: Fit) -> tuple[JointGain, ...]:
        now, then = ((tried.observation, tried.estimate.base) for tried in fits)
        return gains(now, then, now[0].parts(problem.held_out)[1])

    return verify(found, tried, gained)
