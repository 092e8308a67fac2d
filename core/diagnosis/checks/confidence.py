"""Say how sure a finding is: a number set on simulated logs with known causes, and checked on others.

Three things decide: how far its rise lies above what luck gives, how far its criterion leads over the best
rival and over patterns without a name, and whether it helps on rows that no fit has seen. Source: Platt,
Advances in Large Margin Classifiers (1999), for the logistic form.
"""

import numpy as np

from ..result import Gain

CERTAIN = 0.99


def confidence(statistic: float, margin: float, measured: Gain | None) -> float:
    """Give the chance that the named cause is the true one."""
    strength = np.clip((statistic - 25.0) / 25.0, -1.0, 2.0)
    lead = np.clip(margin / 6.0, -1.0, 4.0)
    helps = 0.0 if measured is None else float(np.sign(measured.interval_95[0]))
    score = 0.6 + 0.7 * strength + 0.8 * lead + 0.5 * helps
    return float(min(1.0 / (1.0 + np.exp(-score)), CERTAIN))
