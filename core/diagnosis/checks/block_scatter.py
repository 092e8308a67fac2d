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
    changes = _changes(fitter, chosen)[:, chosen.columns_of(index)]
    blocks, width = changes.shape
    freedom = blocks - width
    if freedom < 1:
        return 0.0
    scale = np.sqrt(np.maximum(np.diag(model), np.finfo(float).tiny))
    scatter = blocks / (blocks - 1) * (changes / scale).T @ (changes / scale)
    over_noise = float(np.trace(np.linalg.solve(model / np.outer(scale, scale), scatter)))
    least = max(min(statistic, wald_statistic(chosen, index)), 0.0)
    chance = float(
        fdtrc(width, freedom, least / max(over_noise, np.finfo(float).tiny) * freedom / (blocks - 1))
    )
    return float(min(np.log(max(chance, np.finfo(float).tiny)) + np.log(member.trials * fitter.kinds), 0.0))


def _changes(fitter: HypothesisFitter, chosen: Hypothesis) -> Matrix:
    """Give by how much each block's rows pull every coefficient, blocks x coefficients."""
    block = row_blocks(fitter.dataset, BLOCK_SCATTER.blocks)
    pulls = np.zeros((int(block.max()) + 1, len(chosen.fit.values)))
    for rows, part, left in zip(fitter.rows.fitted, chosen.fit.joints, chosen.fit.left, strict=True):
        numbers, first = np.unique(block[rows.rows], return_index=True)
        if len(numbers):
            pulls[np.ix_(numbers, part.acting)] += np.add.reduceat(part.columns * left[:, None], first)
    return np.asarray(chosen.fit.solve(pulls[pulls.any(axis=1)].T).T)
