"""Foresee what candidates bring once the noise is learned without them, before any of them is fitted.

Noise that was learned while an effect was unknown holds a part of it, and a scan under that noise says too
little of it: up to a hundred times. Taking the effect out of the residual, as large as the scan says it is,
and learning the noise once more shows most of what is missing for a seventh of what a fit costs.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ...arrays import Weights
from ..regression.ar_noise import fit_ar_noise
from ..regression.gls import Fit, degrees_taken
from ..regression.rows import JointRows, extended
from .fitter import HypothesisFitter
from .hypothesis import Hypothesis, ScoredCandidate

Effect = Mapping[int, Weights]
"""Torque per joint (from 0) and row, N m or N."""


def predicted_likelihood_ratios(
    fitter: HypothesisFitter, now: Hypothesis, scans: Sequence[ScoredCandidate]
) -> list[float]:
    """Give by how much each candidate of a scan may raise twice the log-likelihood."""
    rows = extended(fitter.rows.fitted, fitter.columns(now.members))
    columns = fitter.columns([one.candidate for one in scans])
    effects = (
        {joint: own[rows[joint].rows] @ one.values for joint, own in kind.items()}
        for one, kind in zip(scans, columns, strict=True)
    )
    return [_rise(rows, now.fit, effect) for effect in effects]


def _rise(joints: tuple[JointRows, ...], now: Fit, effect: Effect) -> float:
    """Take an effect out of the residual, and learn the noise anew where it acts, as a fit would.

    A fit under ordinary noise learns it from what the ordinary fit leaves, which has values of its own.
    """
    seen = now.plain or now
    values, seen_values = (one.values - _stands_for(one, effect) for one in (now, seen))
    total = 0.0 if now.prior is None else -0.5 * now.prior.departure(values)
    for joint, (rows, part) in enumerate(zip(joints, now.joints, strict=True)):
        without = replace(rows, torque=rows.torque - effect.get(joint, 0.0))
        left = part.missed(without, values)
        likely = part.noise.log_likelihood(left, rows.place)
        if joint in effect:
            residual = left if seen is now else seen.joints[joint].missed(without, seen_values)
            learned = fit_ar_noise(residual, rows.place, taken=degrees_taken(rows, joints))
            likely = max(likely, learned.log_likelihood(left, rows.place))
        total += likely
    return 2.0 * (total - now.log_likelihood)


def _stands_for(found: Fit, effect: Effect) -> Weights:
    """Give what the fitted columns' coefficients hold of an effect that is not among them."""
    slope = np.zeros(len(found.values))
    for joint, one in effect.items():
        part = found.joints[joint]
        white = (part.whitening @ one)[:, None]
        slope[part.acting] += (part.columns.T @ white - part.inside.T @ part.free.inside(white))[:, 0]
    return found.solve(slope[:, None])[:, 0]
