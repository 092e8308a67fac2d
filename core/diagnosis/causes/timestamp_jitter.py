"""Candidate cause: timestamp jitter, random deviations of the sampling instants from their stamps.

Above the motion's bandwidth such positions carry their velocity times a time error that all joints share.
Products of two joints' high-pass remainders are then on average proportional to products of their velocities;
rounding and noise lack this property. Positions that are held from row to row, as a slower recorder's are,
have it: they are late by a time that all joints share, and say nothing of the stamps.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain

import numpy as np

from ...arrays import Instants, InstantSeries, JointSeries, Vector
from ...dynamics.prediction import Prediction
from ...log.model import LogRows
from ...numerics.distributions import binomial_at_least, normal_tail
from ...numerics.filtering import convolved
from ...signals.derivative import differentiate_throughout
from ...signals.resample import uniform_positions
from ...signals.segment import Segment
from ...signals.zero_phase import kernel
from ..dataset.dataset import Dataset
from ..thresholds.dataset import ROWS, SAMPLE_CHECKS
from .protocol import Quantity, number_text
from .sample_check import Corruption, SampleCheck, SampleFinding, residual_share


@dataclass(frozen=True)
class TimestampJitter(SampleCheck):
    """Candidate cause: jitter of the sampling instants."""

    id = "timestamp_jitter"
    title = "Timestamp jitter"
    units = (("std", "s"),)
    experiment = "fast motion of at least two joints at once"
    beyond_repair = "The instants at which samples were really taken are not in the log"

    def examine(self, dataset: Dataset, operating_point: Prediction) -> tuple[SampleFinding, ...]:
        """Compare the joints' remainders with their velocities."""
        if dataset.joints < 2:
            return ()
        segments = [segment for motion in dataset.motions for segment in motion.segments]
        parts = list(chain.from_iterable(map(_parts, segments)))
        if not parts:
            return ()
        crosses, alone = map(np.concatenate, zip(*map(_products, parts), strict=True))
        shared = float(crosses[:, 0].sum() / max(crosses[:, 1].sum(), 1e-300))
        own = float(alone[:, 0].sum() / max(alone[:, 1].sum(), 1e-300))
        statistic = float(crosses[:, 0].sum() / np.sqrt(max(float(np.sum(crosses[:, 0] ** 2)), 1e-300)))
        p_value = _by_chance(statistic, crosses[:, 0])
        if p_value > SAMPLE_CHECKS.level or shared < SAMPLE_CHECKS.jitter_agreement * own:
            return ()
        std = float(np.sqrt(shared))
        share = residual_share(dataset, operating_point, _jittered(std))
        if share.max() < SAMPLE_CHECKS.jitter_share:
            return ()
        scatter = np.sqrt(np.sum((crosses[:, 0] - shared * crosses[:, 1]) ** 2)) / crosses[:, 1].sum()
        found = Quantity("std", None, "s", std, 0.5 * float(scatter) / std)
        return (SampleFinding((), (found,), _statement(found), statistic, p_value, share),)


def _by_chance(statistic: float, products: Vector) -> float:
    """Give the p-value of the sum of products, or of the count of positive ones: few may dominate the sum."""
    positive, count = int(np.count_nonzero(products > 0.0)), int(np.count_nonzero(products))
    return min(2.0 * min(normal_tail(statistic), binomial_at_least(positive, count, 0.5)), 1.0)


def _statement(found: Quantity) -> str:
    doubt = number_text(1e3 * found.standard_deviation)
    return (
        f"Timestamp jitter, {1e3 * found.value:.3g} ± {doubt} ms RMS: the positions of all joints err by "
        "their velocity times one time error"
    )


def _jittered(std: float) -> Corruption:
    def corrupt(position: JointSeries, velocity: JointSeries, rng: np.random.Generator) -> JointSeries:
        del position
        return velocity * rng.normal(0.0, std, (len(velocity), 1))

    return corrupt


def _parts(segment: Segment) -> Iterator[tuple[JointSeries, JointSeries, float]]:
    """Give remainders, velocities and the remaining share of white noise, over the segment's beginning."""
    rate_hz = segment.rate_hz
    count = min(segment.samples, int(ROWS.seconds * rate_hz))
    low_pass = kernel(SAMPLE_CHECKS.jitter_band * rate_hz, rate_hz, SAMPLE_CHECKS.filter_order)
    reach = len(low_pass) // 2
    if count < SAMPLE_CHECKS.jitter_filters * reach:
        return
    rows = segment.log.source.rows(segment.start, segment.start + count)
    position = uniform_positions(rows, rate_hz, segment.recipe.median_order)
    smooth = convolved(position, low_pass)
    remainder = position[reach:-reach] - smooth
    share = 1.0 - 2.0 * float(low_pass[reach]) + float(low_pass @ low_pass)
    velocity = differentiate_throughout(smooth, rate_hz)
    instants = rows.time[0] + (reach + np.arange(len(velocity))) / rate_hz
    if _held_share(rows, instants, velocity) < SAMPLE_CHECKS.jitter_held:
        yield remainder, velocity, share


def _held_share(rows: LogRows, instants: Instants, velocity: InstantSeries) -> float:
    """Give the share of the motion, by its mean square speed, in which all positions repeat."""
    usual = np.maximum(np.mean(velocity**2, axis=0), np.finfo(float).tiny)
    moving = np.interp(rows.time[1:], instants, np.sum(velocity**2 / usual, axis=1))
    held = np.all(rows.position[1:] == rows.position[:-1], axis=1)
    return float(moving @ held / max(float(np.sum(moving)), np.finfo(float).tiny))


def _products(part: tuple[JointSeries, JointSeries, float]) -> tuple[np.ndarray, np.ndarray]:
    """Give, per block, products of remainders and those that a unit time error would give.

    Between joints, and of joints with themselves less the part that does not grow with speed.
    """
    remainder, velocity, share = part
    scale = np.maximum(np.sqrt(np.mean(remainder**2, axis=0)), 1e-15)
    error, lever = remainder / scale, velocity / scale
    cross = np.sum(error * lever, axis=1) ** 2 - np.sum((error * lever) ** 2, axis=1)
    most = np.sum(lever**2, axis=1) ** 2 - np.sum(lever**4, axis=1)
    above = lever**2 - np.mean(lever**2, axis=0)
    own, square = np.sum(above * error**2, axis=1), np.sum(above * lever**2, axis=1)
    return _blocks(cross, share * most), _blocks(own, share * square)


def _blocks(found: np.ndarray, unit: np.ndarray) -> np.ndarray:
    whole = len(found) // SAMPLE_CHECKS.jitter_block * SAMPLE_CHECKS.jitter_block
    return np.column_stack(
        [products[:whole].reshape(-1, SAMPLE_CHECKS.jitter_block).sum(axis=1) for products in (found, unit)]
    )
