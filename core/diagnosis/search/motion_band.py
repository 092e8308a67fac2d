"""Drop causes that position noise resembles where the motion's own band does not show them.

A controller answers the encoder's error that the log shows. Above the motion, torque and the columns of
springs, delays and filters then hold the same error, and prewhitening raises just those frequencies. A true
one moves the robot: in a band as narrow as the identification's, where that error is small, it is still
significant. Source: Soderstrom, Errors-in-Variables Methods in System Identification (2018), ch. 1.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...errors import ExcitationError
from ..dataset.dataset import Dataset, identification_width
from ..thresholds.dataset import BAND
from ..thresholds.search import ENTRY
from .fitter import HypothesisFitter, hypothesis_fitter
from .hypothesis import Hypothesis
from .likelihood_ratio import log_p
from .state import SearchState
from .stepwise import continue_search

At = Callable[[float], Dataset]
"""Gives the data set of a width."""


def drop_what_motion_does_not_show(found: SearchState, at: At) -> SearchState:
    """Drop such members one by one, and search on without them; none of them may enter again."""
    state, dropped = found, {}
    while (weak := _weak(state, at)) is not None:
        member, without = state.chosen.members[weak], state.fitter.fit_without_each(state.chosen)[weak]
        dropped[member.key] = np.inf
        less = state.linearised_at(without).recorded("dropped", member, 0.0)
        state = continue_search(less.excluding(member.key))
    return replace(state, excluded=dropped)


def _weak(state: SearchState, at: At) -> int | None:
    """Give the first member that noise resembles and the motion's band does not show."""
    fitter, chosen = state.fitter, state.chosen
    doubtful = [
        place for place, member in enumerate(chosen.members) if member.cause.traits.like_position_noise
    ]
    width = min(BAND.narrowest, identification_width(fitter.dataset))
    if not doubtful or fitter.dataset.width <= width:
        return None
    try:
        there = _fitter_on(at(width), fitter)
    except ExcitationError:  # stretches as short as the log's hold no row of so narrow a band
        return None
    whole = there.fit(chosen.members)
    hurdle = float(np.log(ENTRY.confirmed))
    return next((place for place in doubtful if _chance(there, whole, place) > hurdle), None)


def _chance(fitter: HypothesisFitter, whole: Hypothesis, place: int) -> float:
    """Give the logarithm of a member's p-value."""
    members = whole.members
    less = fitter.fit((*members[:place], *members[place + 1 :]))
    return log_p(less, whole, index=place)


def _fitter_on(dataset: Dataset, like: HypothesisFitter) -> HypothesisFitter:
    """Give a fitter of another data set at the same operating point."""
    fitter = hypothesis_fitter(dataset, like.plan, like.causes, like.prior)
    at = replace(like.at, dataset=dataset, left=dataset, columns={}, _known={})
    return replace(fitter, at=at, ordinary_noise=like.ordinary_noise)
