"""Ask whether one cause that acts on the whole robot stands behind several that were found joint by joint.

A search adds one cause at a time. Where every torque is late, the first joint's share of that may pass for a
spring and the next one's for bristles, until nothing is left for the delay to explain; no single swap leads
back. So the search is made again from the whole robot's cause, until it comes to where the first one went on
from, and the better of the two ends is kept.
Source: Miller, Subset Selection in Regression (2002), ch. 3, on local optima.
"""

import numpy as np

from ..causes.masking import excludes, masks
from ..checks.alternatives import UNDECIDED
from .fitter import HypothesisFitter
from .hypothesis import Hypothesis
from .joint_refinement import WORTH_REFINING
from .likelihood_ratio import likelihood_ratio
from .stepwise import Selection, Step, continue_search, start_with

SEVERAL = 2
"""Findings that may be one."""


def restart_from_common_cause(fitter: HypothesisFitter, found: Selection) -> Selection:
    """Give the better of what was found and what a search finds that begins with one cause for several."""
    best, members, believe_best = found, found.chosen.members, fitter.remembered()
    for cause in fitter.causes:
        several = [one for one in members if one.cause.id in masks(cause.id)]
        if len(several) < SEVERAL or cause.id in {one.cause.id for one in members}:
            continue
        fitter.believe(found.chosen)
        gone = {*masks(cause.id), *excludes(cause.id)}
        without = fitter.tried(tuple(one for one in members if one.cause.id not in gone))
        start = start_with(fitter, without, cause.id)
        if start is None:
            continue
        steps = (*found.steps, Step("swapped", start.members[-1], likelihood_ratio(without, start)))
        other = continue_search(fitter, Selection(found.none, start, steps), {}, known=found.through)
        met = other.chosen is not start and frozenset(other.chosen.by_key) in found.through
        if not met and bic(other.chosen) > bic(best.chosen) + UNDECIDED:
            best, believe_best = other, fitter.remembered()
    believe_best()
    return best


def restart_at_operating_point(fitter: HypothesisFitter, found: Selection) -> Selection:
    """Search on from what was found where it explains much less once it is believed, and keep the better end.

    Columns that were built while something else was believed may explain what they should leave to a cause
    that then is never seen.
    """
    believe_before = fitter.remembered()
    fitter.believe(found.chosen)
    now = fitter.tried(found.chosen.members, found.chosen)
    if likelihood_ratio(found.chosen, now) < -WORTH_REFINING:
        other = continue_search(fitter, Selection(found.none, now, found.steps), {})
        if bic(other.chosen) > bic(found.chosen) + UNDECIDED:
            return other
    believe_before()
    return found


def bic(hypothesis: Hypothesis) -> float:
    """Give twice the log-likelihood less what as many parameters would gain by themselves (Bayesian)."""
    rows = max(len(one.torque) for one in hypothesis.fit.joints)
    freedom = sum(hypothesis.freedom(index) + one.searched for index, one in enumerate(hypothesis.members))
    return 2.0 * hypothesis.fit.log_likelihood - freedom * float(np.log(rows))
