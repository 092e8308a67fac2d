"""Give the p-value of a chi-square statistic, however small it is.

Strong effects have p-values far below the smallest number a computer holds, and still have to be put in
order. Source: Abramowitz & Stegun, 6.5.32, for the tail of the incomplete gamma function.
"""

import numpy as np
from scipy.special import chdtr, chdtrc, gammaln

FAR = 1000.0
"""Beyond this statistic the first terms of the tail's series are exact to rounding for few parameters."""
TERMS = 8


def log_chi2_tail(statistic: float, width: int) -> float:
    """Give the logarithm of the chance that a chi-square variable of `width` degrees exceeds a statistic.

    >>> round(log_chi2_tail(3.841459, 1), 4)
    -2.9957
    >>> round(log_chi2_tail(3000.0, 2))
    -1500
    """
    if statistic < width:
        # The chance is nearly one, and what it lacks of that is what is known.
        return float(np.log1p(-chdtr(width, max(statistic, 0.0))))
    if statistic < FAR:
        return float(np.log(chdtrc(width, statistic)))
    half, shape = 0.5 * statistic, 0.5 * width
    steps = np.cumprod((shape - np.arange(1, TERMS)) / half)
    return float(-half + (shape - 1.0) * np.log(half) - gammaln(shape) + np.log1p(steps.sum()))
