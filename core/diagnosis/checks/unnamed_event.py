"""Test for unnamed events: whether a lasting cause has its evidence from a short span without a contact.

A bump, a jerk or a moment of other control has a span and a wrench, but fits no admissible contact. What a
lasting cause explains of it, it explains nowhere else in the log.
"""

from collections.abc import Sequence

import numpy as np

from ..search.confounding import keeps_beside
from ..search.fitter import HypothesisFitter
from ..search.hypothesis import Hypothesis
from ..search.likelihood_ratio import bic_gain, likelihood_ratio
from ..thresholds.search import MASKING


def lead_over_events(
    fitter: HypothesisFitter, without: Hypothesis, own: Hypothesis, trials: Sequence[Hypothesis]
) -> float:
    """Give a lasting member's BIC difference less that of the best event in its place that is no contact.

    Its span and wrench fit, but no listed cause can be it: something else happened then. Where it explains
    much more than the member, the member's evidence is from that span, and not from all the log. Infinite
    where there is none, or each explains as much beside the other.
    """
    if own.members[-1].cause.traits.transient:
        return np.inf
    events = [trial for trial in trials if trial.members[-1].cause.traits.transient and not trial.admissible]
    competing = [trial for trial in events if _compete(fitter, without, own, trial)]
    most = max((bic_gain(without, trial) for trial in competing), default=-np.inf)
    return float(bic_gain(without, own) - most)


def _compete(fitter: HypothesisFitter, without: Hypothesis, own: Hypothesis, trial: Hypothesis) -> bool:
    """Tell whether one of the last members of two hypotheses explains less beside the other."""
    if not keeps_beside(fitter, without, own, trial.members[-1], likelihood_ratio(without, trial)):
        return True
    beside = fitter.fit((*trial.members, own.members[-1]), trial)
    return likelihood_ratio(trial, beside) < MASKING.kept * likelihood_ratio(without, own)
