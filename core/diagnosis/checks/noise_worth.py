"""Bound what noise of the positions may make of a finding that resembles it.

Columns of delays, filters and springs hold the positions' noise at other instants. A fit that adds them up
makes the noise of the accelerations smaller, which looks like the effect, in every part of the log. So such a
finding has to explain more than noise of that size leaves in the residual.
Source: Soderstrom, Errors-in-Variables Methods in System Identification (2018), ch. 1.
"""

import numpy as np

from ..search.fitter import HypothesisFitter
from ..search.hypothesis import Hypothesis
from ..search.likelihood_ratio import likelihood_ratio_by_joint, position_noise_by_joint
from ..thresholds.checks import NOISE_WORTH


def noise_worth(fitter: HypothesisFitter, without: Hypothesis, whole: Hypothesis, index: int) -> float | None:
    """Give the statistic that noise may account for, on the joints that a member helps.

    None where the member does not resemble such noise.
    """
    if not whole.members[index].cause.traits.like_position_noise:
        return None
    gained = likelihood_ratio_by_joint(without, whole)
    helped = gained > NOISE_WORTH.least_gain * np.sum(np.maximum(gained, 0.0))
    return float(np.sum(position_noise_by_joint(fitter, whole)[helped]))
