"""Candidate cause: dropped samples, in whose place the recorder repeated the row before.

Where torques carry noise, positions and torques of all joints never repeat together by chance. The expected
number of such repeats follows from how often each channel repeats by itself.
"""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.stats import poisson

from ...arrays import JointSeries
from ...dynamics.prediction import Prediction
from ...log.model import LogRows
from ...signals.condition import Motion
from ...signals.resample import dropped_mask
from ..dataset.dataset import Dataset
from ..thresholds.dataset import SAMPLE_CHECKS
from .protocol import Quantity
from .sample_check import Corruption, SampleCheck, SampleFinding, residual_share

ROWS = 65_536


@dataclass(frozen=True, eq=False)
class _Count:
    """Count rows, dropped rows, and the repeats expected by chance."""

    rows: int
    dropped: int
    expected: float


@dataclass(frozen=True)
class DroppedSamples(SampleCheck):
    """Candidate cause: dropped samples."""

    id = "dropped_samples"
    title = "Dropped samples"
    units = (("fraction", "1"),)
    experiment = "any motion, recorded with the controller's own sample counter"
    beyond_repair = "Samples that were not recorded are lost; the repeated rows are left out"

    def examine(self, dataset: Dataset, operating_point: Prediction) -> tuple[SampleFinding, ...]:
        """Count rows that repeat while the robot moves."""
        counts = [count for motion in dataset.motions for count in _counted(motion)]
        rows, lost = sum(count.rows for count in counts), sum(count.dropped for count in counts)
        expected = sum(count.expected for count in counts)
        p_value = float(poisson.sf(lost - 1, expected)) if lost else 1.0
        if p_value > SAMPLE_CHECKS.level:
            return ()
        fraction = lost / rows
        deviation = float(np.sqrt(fraction * (1.0 - fraction) / rows))
        return (
            SampleFinding(
                site=(),
                quantities=(Quantity("fraction", None, "1", fraction, deviation),),
                statement=(
                    f"Dropped samples: {lost} of {rows} rows ({100.0 * fraction:.3g} %) repeat all positions "
                    "and torques of the row before while the robot moves; they are left out and interpolated"
                ),
                statistic=float(lost),
                p_value=p_value,
                residual_share=residual_share(dataset, operating_point, _bridged(fraction)),
            ),
        )


def _counted(motion: Motion) -> list[_Count]:
    log = motion.log
    out = []
    for start, stop in log.segments:
        for begin in range(start, stop, ROWS):
            rows = log.source.rows(max(begin - 1, start), min(begin + ROWS, stop))
            if len(rows.time) > 2:
                out.append(_count(rows, motion))
    return out


def _count(rows: LogRows, motion: Motion) -> _Count:
    lost = dropped_mask(rows)
    # While rows repeat, the robot moved if its position differs after them.
    passed = [np.interp(rows.time, rows.time[~lost], column[~lost]) for column in rows.position.T]
    position = np.column_stack(passed)
    reach = min(SAMPLE_CHECKS.dropped_reach, len(rows.time) - 1)
    travel = np.zeros_like(position)
    travel[reach:] = position[reach:] - position[:-reach]
    seconds = reach / motion.log.rate_hz
    moving = np.any(np.abs(travel) > motion.recipe.still_speed * seconds, axis=1)
    lost &= moving
    fresh = moving & ~lost
    chances = [
        (np.sum((column[1:] == column[:-1]) & fresh[1:]) + 0.5) / (np.sum(fresh) + 1.0)
        for channel in (rows.position, rows.current if rows.torque is None else rows.torque)
        if channel is not None
        for column in channel.T
    ]
    return _Count(int(moving.sum()), int(lost.sum()), float(moving.sum() * np.prod(chances)))


def _bridged(fraction: float) -> Corruption:
    """Leave out the same share of rows of a smooth motion and interpolate them, as the study does."""

    def corrupt(position: JointSeries, velocity: JointSeries, rng: np.random.Generator) -> JointSeries:
        del velocity
        index = np.arange(len(position))
        kept = rng.random(len(position)) >= fraction
        kept[[0, -1]] = True
        return np.asarray(CubicSpline(index[kept], position[kept])(index) - position)

    return corrupt
