"""Give a member's likelihood ratio statistic on held-out rows, and its expected value.

Source: Stone, J. R. Stat. Soc. B 36(2), 1974, on judging by data that the choice has not seen.
"""

import numpy as np

from ..regression.prewhitening import prewhitened_residual
from ..regression.rows import JointRows, append_columns
from .fitter import HypothesisFitter
from .hypothesis import Hypothesis


def holdout_likelihood_ratio(
    fitter: HypothesisFitter, now: Hypothesis, trial: Hypothesis, index: int = -1
) -> float:
    """Give the likelihood ratio statistic on held-out rows, at the larger hypothesis's noise.

    A prior counts like rows, in proportion to those that are held out: neither hypothesis was fitted to it.
    """
    share = holdout_share(fitter, trial, index) if fitter.prior else 0.0
    return _ratio_on(fitter, fitter.rows.held_out, now, trial, share)


def expected_holdout_likelihood_ratio(
    fitter: HypothesisFitter, now: Hypothesis, trial: Hypothesis, index: int
) -> float:
    """Give the `holdout_likelihood_ratio` of a member that explains there what it does on fitted rows."""
    return holdout_share(fitter, trial, index) * _ratio_on(fitter, fitter.rows.fitted, now, trial, 1.0)


def holdout_share(fitter: HypothesisFitter, trial: Hypothesis, index: int = -1) -> float:
    """Give the square of a member's white torque on held-out rows over that on the fitted ones."""
    columns = fitter.columns(trial.members)[index]
    values = trial.fit.values[trial.columns_of(index % len(trial.members))]
    squares = []
    for part in (fitter.rows.held_out, fitter.rows.fitted):
        total = 0.0
        for joint, own in columns.items():
            torque = (own[part[joint].rows] @ values)[:, None]
            total += float(np.sum(trial.fit.joints[joint].noise.whitened(torque, part[joint].run_index) ** 2))
        squares.append(total)
    return squares[0] / max(squares[1], 1e-300)


def _ratio_on(
    fitter: HypothesisFitter, joints: tuple[JointRows, ...], now: Hypothesis, trial: Hypothesis, share: float
) -> float:
    rows = [append_columns(joints, fitter.columns(under.members)) for under in (now, trial)]
    squares = np.zeros(2)
    for parts, joint in zip(zip(*rows, strict=True), trial.fit.joints, strict=True):
        fits = zip(parts, (now.fit, trial.fit), strict=True)
        left = [part.left(fit.values) for part, fit in fits]
        squares += np.sum(prewhitened_residual(parts[0], joint.noise, np.column_stack(left)) ** 2, axis=0)
    if fitter.prior:
        squares += [share * fitter.prior.departure(under.fit.values) for under in (now, trial)]
    return float(squares[0] - squares[1])
