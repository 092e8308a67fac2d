"""Measure what a cause brings to a hypothesis: its rise of the likelihood, and the chance of that by luck.

Source: Schwarz, Ann. Stat. 6(2), 1978, for the criterion.
"""

import numpy as np

from ...arrays import JointVector
from .fitter import HypothesisFitter
from .hypothesis import Hypothesis, ScoredCandidate

MOST_OF_A_ROW = 16.0
"""Squared deviations that a row may count for."""


def log_p(now: Hypothesis, trial: Hypothesis, most: float = np.inf, index: int = -1) -> float:
    """Give the log of a member's p-value, corrected for its grid; its statistic is `most` at most.

    `trial` is `now` and this member, which is the last one unless said otherwise; so below.
    """
    statistic = min(wald_statistic(trial, index), likelihood_ratio(now, trial), most)
    return ScoredCandidate(trial.members[index], statistic, trial.freedom(index), np.zeros(0), 1.0).log_p


def bounded_likelihood_ratio(now: Hypothesis, trial: Hypothesis, index: int = -1) -> float:
    """Give the rise where no row counts for more than so many deviations; of an event, over its own rows.

    A few spikes of heavy-tailed noise are no contact and no clipped peak, however large they are.
    """
    own, event = trial.columns_of(index), trial.members[index].cause.traits.transient
    before = np.insert(now.fit.values, own.start, np.zeros(trial.widths[index]))
    total = 0.0
    for part in trial.fit.joints:
        rows = part.of(own).any(axis=1) if event else slice(None)
        old, new = (
            np.minimum(part.left(one)[rows] ** 2, MOST_OF_A_ROW) for one in (before, trial.fit.values)
        )
        total += float(np.sum(old - new))
    return total


def likelihood_ratio(now: Hypothesis, trial: Hypothesis) -> float:
    """Give the rise of twice the log-likelihood from one hypothesis to a larger one."""
    return 2.0 * (trial.fit.log_likelihood - now.fit.log_likelihood)


def likelihood_ratio_by_joint(now: Hypothesis, trial: Hypothesis) -> JointVector:
    """Give the same from each joint's rows."""
    return np.asarray(2.0 * (trial.fit.by_joint - now.fit.by_joint))


def log_p_of(fitter: HypothesisFitter, chosen: Hypothesis, index: int, statistic: float) -> float:
    """Give the log of a member's p-value, corrected for its grid and for all kinds that were scanned.

    `statistic` is the rise that it brings by itself.
    """
    member = chosen.members[index]
    size = min(wald_statistic(chosen, index), statistic)
    scored = ScoredCandidate(member, size, chosen.freedom(index), np.zeros(0), 1.0)
    return min(scored.log_p + float(np.log(fitter.kinds)), 0.0)


def wald_statistic(hypothesis: Hypothesis, index: int) -> float:
    """Give a member's squared size in units of its covariance, under the noise of the whole hypothesis."""
    covariance = hypothesis.covariance(index)
    scale = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    values = hypothesis.fit.values[hypothesis.columns_of(index)] / scale
    return float(values @ np.linalg.solve(covariance / np.outer(scale, scale), values))


def bic_gain(now: Hypothesis, trial: Hypothesis, index: int = -1) -> float:
    """Give the rise less what its parameters would gain by themselves (Bayesian criterion)."""
    rows = max(len(one.torque) for one in trial.fit.joints)
    freedom = trial.freedom(index) + trial.members[index].searched
    return likelihood_ratio(now, trial) - freedom * float(np.log(rows))
