"""Give the confidence of a finding: a logistic model of its evidence, set on drawn logs with known causes.

Three predictors: its likelihood ratio statistic, its BIC lead over the best alternative and over unnamed
patterns, and whether it reduces the error on held-out rows. Source: Platt,
Advances in Large Margin Classifiers (1999), for the logistic form.
"""

import numpy as np

from ..result import Gain
from ..thresholds.checks import CONFIDENCE
from ..thresholds.search import SELECTION


def confidence(statistic: float, margin: float, measured: Gain | None) -> float:
    """Give the probability that the named cause is the true one."""
    strength = np.clip(
        (statistic - CONFIDENCE.clear_statistic) / CONFIDENCE.clear_statistic,
        CONFIDENCE.least_strength,
        CONFIDENCE.most_strength,
    )
    lead = np.clip(margin / SELECTION.undecided, CONFIDENCE.least_lead, CONFIDENCE.most_lead)
    helps = 0.0 if measured is None else float(np.sign(measured.interval_95[0]))
    score = (
        CONFIDENCE.offset
        + CONFIDENCE.per_strength * strength
        + CONFIDENCE.per_lead * lead
        + CONFIDENCE.per_gain * helps
    )
    return float(min(1.0 / (1.0 + np.exp(-score)), CONFIDENCE.certain))
