"""Predict the likelihood ratio statistics of candidates before any of them is fitted.

Noise that was estimated while an effect was unknown has absorbed a part of it, and a score test under that
noise gives too small a statistic, by a factor of up to a hundred. The effect, as large as the score test
finds it, is taken out of the residual and the noise estimated again. That recovers most of the statistic for
a seventh of the cost of a fit.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ...arrays import Weights
from ..regression.ar_noise import fit_ar_noise
from ..regression.gls import Fit, degrees_of_freedom
from ..regression.rows import JointRows, append_columns
from .fitter import HypothesisFitter
from .hypothesis import Hypothesis, ScoredCandidate

Effect = Mapping[int, Weights]
"""Torque per joint (from 0) and row, N m or N."""


def predicted_likelihood_ratios(
    fitter: HypothesisFitter, now: Hypothesis, scans: Sequence[ScoredCandidate]
) -> list[float]:
    """Predict the likelihood ratio statistic of each candidate of a scan."""
    rows = append_columns(fitter.rows.fitted, fitter.columns(now.members))
    columns = fitter.columns([scored.candidate for scored in scans])
    effects = (
        {joint: own[rows[joint].rows] @ scored.values for joint, own in kind.items()}
        for scored, kind in zip(scans, columns, strict=True)
    )
    return [ratio_without_effect(rows, now.fit, effect) for effect in effects]


def ratio_without_effect(joints: tuple[JointRows, ...], now: Fit, effect: Effect) -> float:
    """Take an effect out of the residual, and estimate the noise again where it acts, as a fit would.

    A fit under ordinary noise estimates it from the residual of the ordinary fit, which has its own values.
    """
    seen = now.plain or now
    values, seen_values = (fit.values - _bias_by(fit, effect) for fit in (now, seen))
    total = 0.0 if now.prior is None else -0.5 * now.prior.departure(values)
    for joint, (rows, part) in enumerate(zip(joints, now.joints, strict=True)):
        without = replace(rows, torque=rows.torque - effect.get(joint, 0.0))
        left = part.residual(without, values)
        likely = part.noise.log_likelihood(left, rows.run_index)
        if joint in effect:
            residual = left if seen is now else seen.joints[joint].residual(without, seen_values)
            estimated = fit_ar_noise(residual, rows.run_index, taken=degrees_of_freedom(rows, joints))
            likely = max(likely, estimated.log_likelihood(left, rows.run_index))
        total += likely
    return 2.0 * (total - now.log_likelihood)


def _bias_by(found: Fit, effect: Effect) -> Weights:
    """Give the bias of the fitted coefficients by an effect that is not among the columns."""
    slope = np.zeros(len(found.values))
    for joint, torque in effect.items():
        part = found.joints[joint]
        white = part.white(torque[:, None])
        slope[part.acting] += (part.columns.T @ white - part.inside.T @ part.nuisance.in_span(white))[:, 0]
    return found.solve(slope[:, None])[:, 0]
