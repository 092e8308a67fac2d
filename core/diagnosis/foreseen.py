"""Foresee what candidates bring once the noise is learned without them, before any of them is fitted.

Noise that was learned while an effect was unknown holds a part of it, and a scan under that noise says too
little of it: up to a hundred times. Taking the effect out of the residual, as large as the scan says it is,
and learning the noise once more shows most of what is missing for a tenth of what a fit costs.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from core.arrays import Weights
from core.diagnosis.bench import Bench
from core.diagnosis.equations import degrees_taken
from core.diagnosis.hypothesis import Hypothesis, Scored
from core.diagnosis.noise import learn_noise
from core.diagnosis.rows import JointRows, extended


def foreseen(bench: Bench, now: Hypothesis, scans: Sequence[Scored]) -> list[float]:
    """Give by how much each candidate of a scan may raise twice the log-likelihood."""
    rows = extended(bench.base, bench.columns(now.members))
    columns = bench.columns([one.candidate for one in scans])
    effects = (
        {joint: own[rows[joint].rows] @ one.values for joint, own in kind.items()}
        for one, kind in zip(scans, columns, strict=True)
    )
    return [_rise(rows, now, effect) for effect in effects]


def _rise(joints: tuple[JointRows, ...], now: Hypothesis, effect: dict[int, Weights]) -> float:
    """Take an effect (rows per joint, N m) out of the residual, and learn the noise anew where it acts."""
    values, total = now.fit.values - _stands_for(now, effect), 0.0
    for joint, (rows, part) in enumerate(zip(joints, now.fit.joints, strict=True)):
        left = part.missed(replace(rows, torque=rows.torque - effect.get(joint, 0.0)), values)
        likely = part.noise.log_likelihood(left, rows.place)
        if joint in effect:
            learned = learn_noise(left, rows.place, taken=degrees_taken(rows, joints))
            likely = max(likely, learned.log_likelihood(left, rows.place))
        total += likely
    return 2.0 * (total - float(now.fit.by_joint.sum()))


def _stands_for(now: Hypothesis, effect: dict[int, Weights]) -> Weights:
    """Give what the fitted columns' coefficients hold of an effect that is not among them."""
    slope = np.zeros(len(now.fit.values))
    for joint, one in effect.items():
        part = now.fit.joints[joint]
        white = (part.whitening @ one)[:, None]
        slope[part.acting] += (part.columns.T @ white - part.inside.T @ part.free.inside(white))[:, 0]
    return now.fit.solve(slope[:, None])[:, 0]
