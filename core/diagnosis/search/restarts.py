"""Restart a search where its greedy order may have led to a local optimum.

A search adds one cause at a time. Where every torque is delayed, the delay of one joint may be explained by
joint elasticity and that of the next by presliding, until nothing is left for the delay itself. No single
swap leads back. So the search starts again from the cause of the whole robot, until it reaches a set of
causes that the first search passed, and the better of the two ends is kept.
Source: Miller, Subset Selection in Regression (2002), ch. 3, on local optima.
"""

from collections.abc import Iterator

import numpy as np

from ..causes.masking import excludes, masks
from ..thresholds.search import SELECTION
from .hypothesis import Hypothesis
from .likelihood_ratio import likelihood_ratio
from .state import SearchState
from .stepwise import continue_search, start_with


def restart_from_common_cause(found: SearchState) -> SearchState:
    """Give the better of a search and its restarts from one cause of the whole robot in place of several."""
    best = found
    for other in _restarts(found):
        if explains_more(other, best):
            best = other
    return best


def _restarts(found: SearchState) -> Iterator[SearchState]:
    """Give the ends of restarts that come to no set of causes that the search or one before came through."""
    known = found.through
    for cause in _common_causes(found):
        start = _start_from(found, cause, {*masks(cause), *excludes(cause)})
        if start is not None:
            other = continue_search(start, known=known)
            if other.chosen is start.chosen or other.keys not in known:
                yield other
            known |= other.through


def _common_causes(found: SearchState) -> Iterator[str]:
    """Name the absent causes that two members or more may stand for."""
    present = [member.cause.id for member in found.chosen.members]
    for cause in found.fitter.causes:
        if cause.id not in present and len([name for name in present if name in masks(cause.id)]) > 1:
            yield cause.id


def _start_from(found: SearchState, cause: str, replaced: set[str]) -> SearchState | None:
    """Put one cause of the whole robot in the place of others; None where it is not significant."""
    fitter = found.fitter.linearised_at(found.chosen)
    kept = tuple(member for member in found.chosen.members if member.cause.id not in replaced)
    without = fitter.fit(kept)
    before = SearchState(fitter, found.none, without, found.steps)
    start = start_with(before, cause)
    if start is None:
        return None
    return start.recorded("swapped", start.chosen.members[-1], likelihood_ratio(without, start.chosen))


def restart_at_operating_point(found: SearchState) -> SearchState:
    """Search on from a hypothesis that explains much less where it is linearised at, and keep the better end.

    Columns that were linearised elsewhere may explain what they should leave to another cause.
    """
    fitter = found.fitter.linearised_at(found.chosen)
    now = fitter.fit(found.chosen.members, found.chosen)
    if likelihood_ratio(found.chosen, now) < -SELECTION.undecided:
        other = continue_search(SearchState(fitter, found.none, now, found.steps))
        if explains_more(other, found):
            return other
    return found


def explains_more(other: SearchState, than: SearchState) -> bool:
    """Tell whether the end of a search is clearly better than that of another."""
    return bic(other.chosen) > bic(than.chosen) + SELECTION.undecided


def bic(hypothesis: Hypothesis) -> float:
    """Give twice the log-likelihood less the Bayesian information criterion's penalty."""
    rows = max(len(joint.torque) for joint in hypothesis.fit.joints)
    freedom = sum(
        hypothesis.freedom(index) + member.searched for index, member in enumerate(hypothesis.members)
    )
    return 2.0 * hypothesis.fit.log_likelihood - freedom * float(np.log(rows))
