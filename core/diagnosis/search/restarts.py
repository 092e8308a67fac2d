"""Ask whether one cause that acts on the whole robot stands behind several that were found joint by joint.

A search adds one cause at a time. Where every torque is late, the first joint's share of that may pass for a
spring and the next one's for bristles, until nothing is left for the delay to explain; no single swap leads
back. So the search is made again from the whole robot's cause, until it comes to where the first one went on
from, and the better of the two ends is kept.
Source: Miller, Subset Selection in Regression (2002), ch. 3, on local optima.
"""

import numpy as np

from ..checks.alternatives import INDIFFERENCE
from .fitter import Bench
from .hypothesis import Hypothesis
from .joint_refinement import WORTH_SETTLING
from .likelihood_ratio import rise
from .stepwise import Selection, Step, begun_with, continued

SEVERAL = 2
"""Findings that may be one."""


def consolidated(bench: Bench, found: Selection) -> Selection:
    """Give the better of what was found and what a search finds that begins with one cause for several."""
    best, members, believe_best = found, found.chosen.members, bench.remembered()
    for cause in bench.causes:
        several = [one for one in members if one.cause.id in cause.leaves]
        if len(several) < SEVERAL or cause.id in {one.cause.id for one in members}:
            continue
        bench.believe(found.chosen)
        gone = {*cause.leaves, *cause.excludes}
        without = bench.tried(tuple(one for one in members if one.cause.id not in gone))
        start = begun_with(bench, without, cause.id)
        if start is None:
            continue
        steps = (*found.steps, Step("swapped", start.members[-1], rise(without, start)))
        other = continued(bench, Selection(found.none, start, steps), {}, known=found.through)
        met = other.chosen is not start and frozenset(other.chosen.by_key) in found.through
        if not met and criterion(other.chosen) > criterion(best.chosen) + INDIFFERENCE:
            best, believe_best = other, bench.remembered()
    believe_best()
    return best


def reconsidered(bench: Bench, found: Selection) -> Selection:
    """Search on from what was found where it explains much less once it is believed, and keep the better end.

    Columns that were built while something else was believed may explain what they should leave to a cause
    that then is never seen.
    """
    believe_before = bench.remembered()
    bench.believe(found.chosen)
    now = bench.tried(found.chosen.members, found.chosen)
    if rise(found.chosen, now) < -WORTH_SETTLING:
        other = continued(bench, Selection(found.none, now, found.steps), {})
        if criterion(other.chosen) > criterion(found.chosen) + INDIFFERENCE:
            return other
    believe_before()
    return found


def criterion(hypothesis: Hypothesis) -> float:
    """Give twice the log-likelihood less what as many parameters would gain by themselves (Bayesian)."""
    rows = max(len(one.torque) for one in hypothesis.fit.joints)
    freedom = sum(hypothesis.freedom(index) + one.searched for index, one in enumerate(hypothesis.members))
    return 2.0 * hypothesis.fit.log_likelihood - freedom * float(np.log(rows))
