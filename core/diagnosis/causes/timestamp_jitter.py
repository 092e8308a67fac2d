"""Suspect that samples were taken at instants that scatter about their stamps.

Above the motion's band such a log's positions carry their velocity times one time error that all joints
share; products of two joints' remainders are then on average the products of their velocities, which neither
rounding nor noise does.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from scipy.signal import oaconvolve
from scipy.stats import binom, norm

from ...arrays import JointSeries, Vector
from ...dynamics.prediction import Prediction
from ...log.model import LogRows
from ...signals.resample import dropped, is_uniform, on_grid
from ...signals.segment import Segment
from ...signals.zero_phase import kernel
from ..dataset.dataset import Dataset
from .protocol import Cure, Quantity
from .sample_check import LEVEL, SampleFinding, Spoil, residual_share
from .shared.common import rounded

LOOK_SECONDS = 120.0
BAND_SHARE = 0.25
"""Remainders are what lies above this share of the log's rate."""
AGREEMENT = 0.5
"""Joints agree where their products show at least this share of what their squares show."""
LEAST_SHARE = 1e-3
"""Share of some joint's residual that it must account for: rounding of exact positions scatters too."""
BLOCK = 32


@dataclass(frozen=True)
class TimestampJitter:
    """Suspect jitter of the sampling instants."""

    id: ClassVar[str] = "timestamp_jitter"
    title: ClassVar[str] = "Sampling instants scatter about their stamps"
    cure: ClassVar[Cure] = "signal"
    units: ClassVar[tuple[tuple[str, str], ...]] = (("std", "s"),)
    experiment: ClassVar[str] = "quick motion of at least two joints at once"
    beyond_repair: ClassVar[str] = "At which instants the samples were really taken is not in the log"

    def examine(self, dataset: Dataset, operating_point: Prediction) -> tuple[SampleFinding, ...]:
        """Compare the joints' remainders with their velocities."""
        if dataset.joints < 2:
            return ()
        parts = [
            part for motion in dataset.motions for segment in motion.segments for part in _parts(segment)
        ]
        if not parts:
            return ()
        crosses, alone = (np.concatenate(one) for one in zip(*map(_products, parts), strict=True))
        shared = float(crosses[:, 0].sum() / max(crosses[:, 1].sum(), 1e-300))
        own = float(alone[:, 0].sum() / max(alone[:, 1].sum(), 1e-300))
        statistic = float(crosses[:, 0].sum() / np.sqrt(max(float(np.sum(crosses[:, 0] ** 2)), 1e-300)))
        p_value = _by_chance(statistic, crosses[:, 0])
        if p_value > LEVEL or shared < AGREEMENT * own:
            return ()
        std = float(np.sqrt(shared))
        share = residual_share(dataset, operating_point, _jittered(std))
        if share.max() < LEAST_SHARE:
            return ()
        scatter = np.sqrt(np.sum((crosses[:, 0] - shared * crosses[:, 1]) ** 2)) / crosses[:, 1].sum()
        found = Quantity("std", None, "s", std, 0.5 * float(scatter) / std)
        return (SampleFinding((), (found,), _statement(found), statistic, p_value, share),)


def _by_chance(statistic: float, products: Vector) -> float:
    """Give the chance of such a sum of products, or of so many positive ones: a few may outweigh the rest."""
    positive, count = np.count_nonzero(products > 0.0), np.count_nonzero(products)
    return float(min(2.0 * min(norm.sf(statistic), binom.sf(positive - 1, count, 0.5)), 1.0))


def _statement(found: Quantity) -> str:
    doubt = rounded(1e3 * found.standard_deviation)
    return (
        f"Samples were taken {1e3 * found.value:.3g} ± {doubt} ms (standard "
        "deviation) about their stamps: all joints' positions err by velocity times one time error"
    )


def _jittered(std: float) -> Spoil:
    def spoil(position: JointSeries, velocity: JointSeries, rng: np.random.Generator) -> JointSeries:
        del position
        return velocity * rng.normal(0.0, std, (len(velocity), 1))

    return spoil


def _parts(segment: Segment) -> Iterator[tuple[JointSeries, JointSeries, float]]:
    """Give remainders, velocities and the share of white noise that remains, over the segment's beginning."""
    rate_hz = segment.rate_hz
    count = min(segment.samples, int(LOOK_SECONDS * rate_hz))
    low_pass = kernel(BAND_SHARE * rate_hz, rate_hz, 5)
    reach = len(low_pass) // 2
    if count < 8 * reach:
        return
    position = _even(segment.log.source.rows(segment.start, segment.start + count), rate_hz)
    smooth = oaconvolve(position, low_pass[:, None], mode="valid", axes=0)
    remainder = position[reach:-reach] - smooth
    share = 1.0 - 2.0 * float(low_pass[reach]) + float(low_pass @ low_pass)
    yield remainder, np.gradient(smooth, 1.0 / rate_hz, axis=0), share


def _even(rows: LogRows, rate_hz: float) -> JointSeries:
    """Take positions as the study takes them: real stamps honoured, repeats left out."""
    if is_uniform(rows.time, rate_hz) and not dropped(rows).any():
        return rows.position
    grid = np.linspace(rows.time[0], rows.time[-1], len(rows.time))
    return np.asarray(on_grid(rows, rows.position, grid)[0])


def _products(part: tuple[JointSeries, JointSeries, float]) -> tuple[np.ndarray, np.ndarray]:
    """Give, per block, products of remainders with what a unit of time error makes of them.

    Between joints, and of joints with themselves less what does not grow with speed.
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
    whole = len(found) // BLOCK * BLOCK
    return np.column_stack([one[:whole].reshape(-1, BLOCK).sum(axis=1) for one in (found, unit)])
