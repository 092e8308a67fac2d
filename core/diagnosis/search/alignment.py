"""Restart a search from the delay at which torques and positions fit together, found by shifting the torque.

A column of first order is the predicted torque's change, and the prediction is the model's as fitted to the
delayed log. Where all torques are late by many milliseconds and friction is large, that model is far off, and
filters or springs fit better than the delay. The measured torque itself can be shifted. It shows the delay at
which the model fits best, and the model there, from which the columns are right. Source: Ljung, System
Identification (1999), ch. 7 and 10, on profiles of what is not linear.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache

import numpy as np
from scipy.optimize import minimize_scalar

from ...arrays import JointSeries
from ..causes.masking import excludes, masks
from ..causes.time_delay import TimeDelay
from ..thresholds.search import ALIGNMENT, SELECTION
from .fitter import HypothesisFitter
from .hypothesis import Candidate, Hypothesis
from .likelihood_ratio import likelihood_ratio
from .restarts import explains_more
from .state import SearchState
from .stepwise import continue_search

PARTS = (-1.0, -0.5, -0.25, -0.125, 0.0, 0.125, 0.25, 0.5, 1.0)
"""Delays that are tried first, as parts of the largest."""
Later = Callable[[float], JointSeries]
"""Gives the data set's torque, taken so many seconds later."""
Lost = Callable[[float], float]
"""Gives the negative log-likelihood where the torque is taken so many seconds later."""


def restart_from_alignment(found: SearchState, later: Later) -> SearchState:
    """Give the better of a search and its restart from the exact delay, which members may stand for.

    A restart that ends without the delay says that they do not.
    """
    if all(member.cause.id == TimeDelay.id for member in found.chosen.members):
        return found
    kept = _without_stand_ins(found.chosen.members)
    fitter = found.fitter.linearised_at(found.fitter.fit(kept))
    # Far from the delay the model fits little, and a free noise would take up all of a smooth torque.
    ordinary = replace(fitter, ordinary_noise=True)

    @cache
    def shifted(seconds: float) -> SearchState:
        own = ordinary.with_torque(later(seconds))
        return found.at(own, own.fit(kept))

    def lost(seconds: float) -> float:
        return -shifted(seconds).chosen.fit.log_likelihood

    if not _is_promising(lost):
        return found
    delay = _likeliest(lost)
    there = fitter.linearised_at(shifted(delay).chosen)
    start = _start_with_delay(found, there, fitter.fit(kept), delay)
    if start is None:
        return found
    other = continue_search(start, known=found.through)
    delayed = any(member.cause.id == TimeDelay.id for member in other.chosen.members)
    return other if delayed and explains_more(other, found) else found


def _without_stand_ins(members: Sequence[Candidate]) -> tuple[Candidate, ...]:
    """Leave out the delay, and what may stand for it."""
    stand_ins = {*masks(TimeDelay.id), *excludes(TimeDelay.id), TimeDelay.id}
    return tuple(member for member in members if member.cause.id not in stand_ins)


def _start_with_delay(
    found: SearchState, fitter: HypothesisFitter, without: Hypothesis, delay: float
) -> SearchState | None:
    """Put the delay beside the members of a hypothesis; None where it is not significant."""
    candidates = fitter.at.of_kind((TimeDelay.id, ()))
    if not candidates:
        return None
    start = fitter.fit((*without.members, replace(candidates[0], scalars={"around": delay})))
    brings = likelihood_ratio(without, start)
    if not start.admissible or brings < SELECTION.undecided:
        return None
    begun = found.at(fitter, start).recorded("swapped", start.members[-1], brings)
    return replace(begun, excluded={})


def _is_promising(lost: Lost) -> bool:
    """Tell whether the least of a parabola through three delays can be worth a restart."""
    step = ALIGNMENT.furthest * min(part for part in PARTS if part > 0.0)
    before, now, after = lost(-step), lost(0.0), lost(step)
    slope, curvature = 0.5 * (after - before), before - 2.0 * now + after
    return curvature <= 0.0 or slope**2 / curvature > SELECTION.undecided  # twice what the least gains


def _likeliest(lost: Lost) -> float:
    """Refine the best of some delays, s."""
    steps = [ALIGNMENT.furthest * part for part in PARTS]
    best = int(np.argmin([lost(seconds) for seconds in steps]))
    around = steps[max(best - 1, 0)], steps[min(best + 1, len(steps) - 1)]
    return float(
        minimize_scalar(lost, bounds=around, method="bounded", options={"xatol": ALIGNMENT.tolerance}).x
    )
