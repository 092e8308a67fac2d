"""Bound what noise of the positions may make of a finding that resembles it.

Columns of delays, filters and springs hold the positions' noise at other instants. A fit that adds them up
makes the noise of the accelerations smaller, which looks like the effect, in every part of the log. So such a
finding has to explain more than noise of that size leaves in the residual.
Source: Soderstrom, Errors-in-Variables Methods in System Identification (2018), ch. 1.
"""

import numpy as np

from ..result import Evidence
from ..search.fitter import HypothesisFitter
from ..search.hypothesis import Hypothesis
from ..search.likelihood_ratio import likelihood_ratio_by_joint, position_noise_by_joint
from ..thresholds.checks import NOISE_WORTH
from .alternatives import Comparison


def noise_evidence(fitter: HypothesisFitter, chosen: Hypothesis, own: Comparison) -> tuple[Evidence, ...]:
    """Give the statistic that noise may account for, on the joints that gain; none of other causes."""
    if not own.member.cause.traits.like_position_noise:
        return ()
    gained = likelihood_ratio_by_joint(own.without, chosen)
    helped = gained > NOISE_WORTH.least_gain * np.sum(np.maximum(gained, 0.0))
    worth = float(np.sum(position_noise_by_joint(fitter, chosen)[helped]))
    return (
        Evidence(
            "Log-likelihood ratio statistic that noise of the positions may account for; a finding of less "
            f"than {NOISE_WORTH.times:g} times as much is doubtful",
            "position noise",
            worth,
        ),
    )


def may_be_noise(own: Comparison, evidence: tuple[Evidence, ...]) -> bool:
    """Tell whether a finding's statistic is not far above what noise may account for."""
    return any(own.statistic < NOISE_WORTH.times * one.value for one in evidence)
