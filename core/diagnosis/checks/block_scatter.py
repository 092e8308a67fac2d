"""Test a finding by its scatter between blocks of the log, which trusts no model of the noise.

A likelihood ratio is as good as the noise model. On a measured robot the larger part of a residual is what no
model explains, and it differs from one part of the motion to the next. How much the rows of each block alone
would change the coefficients gives their covariance, whatever the residual is. Sources: Liang & Zeger,
Biometrika 73(1), 1986; Cameron & Miller, J. Human Resources 50(2), 2015, on Student's and Fisher's laws with
one degree of freedom less than there are blocks.
"""

import numpy as np
from scipy.special import fdtrc

from ...arrays import Matrix
from ..residual.blocks import row_blocks
from ..search.fitter import HypothesisFitter
from ..search.hypothesis import Hypothesis
from ..search.likelihood_ratio import wald_statistic
from ..thresholds.checks import BLOCK_SCATTER


def block_log_p(fitter: HypothesisFitter, chosen: Hypothesis, index: int, statistic: float) -> float:
    """Give the log of a member's p-value by its scatter between blocks, corrected for all that was scanned.

    Parameters
    ----------
    statistic
        Its likelihood ratio statistic; its Wald statistic counts where that is smaller.
    """
    member, model = chosen.members[index], chosen.covariance(index)
    changes = _changes(fitter, chosen, index)
    blocks, width = changes.shape
    freedom = blocks - width
    if freedom < 1:
        return 0.0
    scale = np.sqrt(np.maximum(np.diag(model), np.finfo(float).tiny))
    scatter = blocks / (blocks - 1) * (changes / scale).T @ (changes / scale)
    over_noise = float(np.trace(np.linalg.solve(model / np.outer(scale, scale), scatter)))
    over_noise = max(over_noise, width)  # no effect is known better than its noise lets it be
    least = max(min(statistic, wald_statistic(chosen, index)), 0.0)
    chance = float(fdtrc(width, freedom, least / over_noise * freedom / (blocks - 1)))
    return float(min(np.log(max(chance, np.finfo(float).tiny)) + np.log(member.trials * fitter.kinds), 0.0))


def _changes(fitter: HypothesisFitter, chosen: Hypothesis, index: int) -> Matrix:
    """Give how much each block's rows alone change a member's coefficients, blocks x coefficients.

    What the error of its columns, which are of first order, may do to the block's share is no scatter.
    """
    own, tiny = chosen.columns_of(index), np.finfo(float).tiny
    inverse = chosen.fit.covariance[:, own]
    weights = inverse / np.sqrt(np.maximum(np.diag(inverse[own]), tiny))
    block = row_blocks(fitter.dataset, BLOCK_SCATTER.blocks)
    change = np.zeros((int(block.max()) + 1, inverse.shape[1]))
    share = np.zeros(len(change))
    for rows, part, left in zip(fitter.rows.fitted, chosen.fit.joints, chosen.fit.left, strict=True):
        numbers, first = np.unique(block[rows.rows], return_index=True)
        if len(numbers):
            change[numbers] += np.add.reduceat(part.columns @ inverse[part.acting] * left[:, None], first)
            beside = part.nuisance.without_nuisance(part.columns @ weights[part.acting])
            share[numbers] += np.add.reduceat(np.sum(beside**2, axis=1), first)
    seen = np.unique(np.concatenate([block[rows.rows] for rows in fitter.rows.fitted]))
    change, share = change[seen], share[seen, None] / max(float(share.sum()), tiny)
    inexact = chosen.members[index].cause.traits.linearisation_error * np.abs(chosen.fit.values[own])
    return np.asarray(np.sign(change) * np.maximum(np.abs(change) - inexact * share, 0.0))
