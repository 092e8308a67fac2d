"""Give the confidence of a finding: a logistic model of its evidence, set on drawn logs with known causes.

Three predictors: its likelihood ratio statistic, its BIC lead over the best alternative and over unnamed
patterns, and whether it reduces the error on held-out rows. Source: Platt,
Advances in Large Margin Classifiers (1999), for the logistic form.
"""

import numpy as np

from ..result import Gain

CERTAIN = 0.99


def confidence(statistic: float, margin: float, measured: Gain | None) -> float:
    """Give the probability that the named cause is the true one."""
    strength = np.clip((statistic - 25.0) / 25.0, -1.0, 2.0)
    lead = np.clip(margin / 6.0, -1.0, 4.0)
    helps = 0.0 if measured is None else float(np.sign(measured.interval_95[0]))
    score = 0.6 + 0.7 * strength + 0.8 * lead + 0.5 * helps
    return float(min(1.0 / (1.0 + np.exp(-score)), CERTAIN))
