"""Test a finding by its scatter between blocks of the log, which trusts no model of the noise.

A likelihood ratio is as good as the noise model. On a measured robot the larger part of a residual is what no
model explains, and it differs from one part of the motion to the next. How much the coefficients change where
a block is left out gives their covariance, whatever the residual is. What one block alone shows then scatters
as much as it is: a jump of the positions, or a brake that drags at first, is fitted exactly and leaves no
residual there. Sources: Tukey, Ann. Math. Stat. 29, 1958, and Bell & McCaffrey, Survey Methodology 28(2),
2002, on the jackknife between clusters; Cameron & Miller, J. Human Resources 50(2), 2015, on Student's and
Fisher's laws with one degree of freedom less than there are blocks.
"""

import numpy as np
from scipy.special import fdtrc

from ...arrays import Matrix
from ..search.fitter import HypothesisFitter
from ..search.hypothesis import Hypothesis
from ..search.likelihood_ratio import wald_statistic
from .block_equations import BlockSolution


def block_log_p(
    fitter: HypothesisFitter, chosen: Hypothesis, index: int, statistic: float, equations: BlockSolution
) -> float:
    """Give the log of a member's p-value by its scatter between blocks, corrected for all that was scanned.

    Parameters
    ----------
    statistic
        Its likelihood ratio statistic; its Wald statistic counts where that is smaller.
    equations
        Those of the hypothesis, block by block.
    """
    member, model = chosen.members[index], chosen.covariance(index)
    changes = _changes(chosen, index, equations)
    blocks, width = changes.shape
    freedom = blocks - width
    if freedom < 1:
        return 0.0
    scale = np.sqrt(np.maximum(np.diag(model), np.finfo(float).tiny))
    scatter = (blocks - 1) / blocks * (changes / scale).T @ (changes / scale)
    over_noise = float(np.trace(np.linalg.solve(model / np.outer(scale, scale), scatter)))
    over_noise = max(over_noise, width)  # no effect is known better than its noise lets it be
    least = max(min(statistic, wald_statistic(chosen, index)), 0.0)
    chance = float(fdtrc(width, freedom, least / over_noise * freedom / (blocks - 1)))
    return float(min(np.log(max(chance, np.finfo(float).tiny)) + np.log(member.trials * fitter.kinds), 0.0))


def _changes(chosen: Hypothesis, index: int, equations: BlockSolution) -> Matrix:
    """Give how much leaving out a block changes a member's coefficients, blocks x coefficients.

    What the error of its columns, which are of first order, may do to the block's share is no scatter.
    """
    own, tiny = chosen.columns_of(index), np.finfo(float).tiny
    change = equations.left_out[:, own]
    inverse = chosen.fit.covariance[:, own]
    weights = inverse / np.sqrt(np.maximum(np.diag(inverse[own]), tiny))
    share = np.array([np.sum(weights * (block.gram @ weights)) for block in equations.blocks])
    share /= max(float(share.sum()), tiny)
    over_others = (share / np.maximum(1.0 - share, tiny))[:, None]
    inexact = chosen.members[index].cause.traits.linearisation_error * np.abs(chosen.fit.values[own])
    return np.asarray(np.sign(change) * np.maximum(np.abs(change) - inexact * over_others, 0.0))
