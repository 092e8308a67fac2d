"""Measure what a cause adds to a hypothesis: likelihood ratio, BIC gain, Wald statistic and p-value.

Source: Schwarz, Ann. Stat. 6(2), 1978, for the criterion.
"""

import numpy as np

from ...arrays import JointVector
from ..thresholds.search import ENTRY
from .fitter import HypothesisFitter
from .hypothesis import Hypothesis, ScoredCandidate


def log_p(now: Hypothesis, trial: Hypothesis, most: float = np.inf, index: int = -1) -> float:
    """Give the log of a member's p-value, corrected for its grid; its statistic is limited to `most`.

    `trial` is `now` and this member, the last one by default; so below.
    """
    statistic = min(wald_statistic(trial, index), likelihood_ratio(now, trial), most)
    return ScoredCandidate(trial.members[index], statistic, trial.freedom(index), np.zeros(0), 1.0).log_p


def bounded_likelihood_ratio(now: Hypothesis, trial: Hypothesis, index: int = -1) -> float:
    """Give the likelihood ratio statistic with each row's share limited; of a transient cause, on its rows.

    A few spikes of heavy-tailed noise are no contact and no saturated peak, however large they are.
    """
    own, event = trial.columns_of(index), trial.members[index].cause.traits.transient
    before = np.insert(now.fit.values, own.start, np.zeros(trial.widths[index]))
    total = 0.0
    for part in trial.fit.joints:
        rows = part.of(own).any(axis=1) if event else slice(None)
        old, new = (
            np.minimum(part.left(values)[rows] ** 2, ENTRY.row_limit) for values in (before, trial.fit.values)
        )
        total += float(np.sum(old - new))
    return total


def likelihood_ratio(now: Hypothesis, trial: Hypothesis) -> float:
    """Give the likelihood ratio statistic of a larger hypothesis: twice the rise of the log-likelihood."""
    return 2.0 * (trial.fit.log_likelihood - now.fit.log_likelihood)


def likelihood_ratio_by_joint(now: Hypothesis, trial: Hypothesis) -> JointVector:
    """Give its part from each joint's rows."""
    return np.asarray(2.0 * (trial.fit.by_joint - now.fit.by_joint))


def position_noise_by_joint(fitter: HypothesisFitter, under: Hypothesis) -> JointVector:
    """Give the sum of squares, per joint, of a draw of the positions' noise, made white as the residual."""
    torque, sums = fitter.dataset.position_torque, []
    for rows, part, made in zip(fitter.rows.fitted, under.fit.joints, torque.T, strict=True):
        sums.append(float(np.sum(part.noise.whitened(made[rows.rows, None], rows.run_index) ** 2)))
    return np.array(sums)


def log_p_of(fitter: HypothesisFitter, chosen: Hypothesis, index: int, statistic: float) -> float:
    """Give the log of a member's p-value, corrected for its grid and for all kinds that were scanned.

    `statistic` is its own likelihood ratio statistic.
    """
    member = chosen.members[index]
    size = min(wald_statistic(chosen, index), statistic)
    scored = ScoredCandidate(member, size, chosen.freedom(index), np.zeros(0), 1.0)
    return min(scored.log_p + float(np.log(fitter.kinds)), 0.0)


def wald_statistic(hypothesis: Hypothesis, index: int) -> float:
    """Give a member's Wald statistic: squared size over covariance, at the whole hypothesis's noise."""
    covariance = hypothesis.covariance(index)
    scale = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    values = hypothesis.fit.values[hypothesis.columns_of(index)] / scale
    return float(values @ np.linalg.solve(covariance / np.outer(scale, scale), values))


def bic_gain(now: Hypothesis, trial: Hypothesis, index: int = -1) -> float:
    """Give the BIC difference: the likelihood ratio statistic less the penalty of a member's parameters."""
    rows = max(len(joint.torque) for joint in trial.fit.joints)
    freedom = trial.freedom(index) + trial.members[index].searched
    return likelihood_ratio(now, trial) - freedom * float(np.log(rows))
