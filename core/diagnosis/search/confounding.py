"""Distinguish a cause from the remainder of another: by what it explains beside it, and by where it acts."""

import numpy as np

from ..causes.masking import masks
from ..thresholds.search import MASKING
from .fitter import HypothesisFitter
from .hypothesis import Candidate, Hypothesis
from .likelihood_ratio import bounded_likelihood_ratio, likelihood_ratio, likelihood_ratio_by_joint, log_p


def is_masked(fitter: HypothesisFitter, whole: Hypothesis, index: int, less: Hypothesis) -> bool:
    """Tell whether a member resembles what another one leaves, and explains too little to be a cause.

    It does where half of its likelihood ratio statistic, joint by joint, is no more than a quarter of the
    other's there. On a joint of its own it has to have half the other's statistic. A transient member does
    where it happens only while the other acts and explains less. It also does beside any member that
    explains many times as much, unless its p-value is extremely small.

    Parameters
    ----------
    less
        The hypothesis without the member.
    """
    own, own_ratio = whole.members[index].cause, likelihood_ratio_by_joint(less, whole)
    for other_index, other in enumerate(whole.members):
        leaves = own.id in masks(other.cause.id)
        if other_index == index or not (leaves or own.traits.transient):
            continue
        without = fitter.fit((*whole.members[:other_index], *whole.members[other_index + 1 :]), whole)
        if own.traits.transient:
            within = leaves and _acts_within(whole, index, other_index)
            if _is_masked_event(less, whole, without, index, within=within):
                return True
            continue
        left = MASKING.left * np.maximum(likelihood_ratio_by_joint(without, whole), 0.0)
        if np.maximum(own_ratio - left, 0.0).sum() < MASKING.kept * own_ratio.sum():
            return True
    return False


def _is_masked_event(
    less: Hypothesis, whole: Hypothesis, without: Hypothesis, index: int, *, within: bool
) -> bool:
    """Tell whether a transient member explains less than another, within which alone it happens or not."""
    least = likelihood_ratio(without, whole) * (1.0 if within else MASKING.event_over_other)
    explains_less = likelihood_ratio_by_joint(less, whole).sum() < least
    return bool(explains_less) and (within or not _is_extreme(less, whole, index))


def keeps_beside(
    fitter: HypothesisFitter, without: Hypothesis, own: Hypothesis, other: Candidate, alone: float
) -> bool:
    """Tell whether a candidate explains as much beside a hypothesis: then it is no alternative.

    Noise that has absorbed a part of the candidate lowers its score, while its likelihood ratio is at its own
    noise. On other joints than the last member's, scores are compared with scores.

    Parameters
    ----------
    without, own
        The hypothesis without its last member, and with it.
    alone
        The candidate's likelihood ratio statistic in the last member's place.
    """
    beside = fitter.scan(own, [other])[0].statistic
    if beside > MASKING.kept * alone:
        return True
    here = own.members[-1].site
    if not here or not other.site or not set(here).isdisjoint(other.site):
        return False
    return beside > MASKING.kept * fitter.scan(without, [other])[0].statistic


def is_masked_by_last(fitter: HypothesisFitter, own: Hypothesis, other: Candidate) -> bool:
    """Tell whether a candidate is transient and the last member leaves it, as by torque at its limit."""
    if not other.cause.traits.transient or other.cause.id not in masks(own.members[-1].cause.id):
        return False
    both = fitter.fit_with(own, other)
    return _acts_within(both, len(own.members), len(own.members) - 1)


def _is_extreme(less: Hypothesis, whole: Hypothesis, index: int) -> bool:
    chance = log_p(less, whole, bounded_likelihood_ratio(less, whole, index), index)
    return bool(chance < np.log(MASKING.event_level))


def _acts_within(whole: Hypothesis, index: int, other_index: int) -> bool:
    """Tell whether one member acts hardly ever except while another does, on the joints of the other."""
    together = alone = 0
    for part in whole.fit.joints:
        acts, other = (part.of(whole.columns_of(member)).any(axis=1) for member in (index, other_index))
        if other.any():
            together += int((acts & other).sum())
            alone += int((acts & ~other).sum())
    return together > MASKING.within * (together + alone)
