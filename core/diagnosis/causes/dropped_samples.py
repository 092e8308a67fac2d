"""Candidate cause: dropped samples, in whose place the recorder repeated the row before.

Where torques carry noise, positions and torques of all joints never repeat together by chance. The expected
number of such repeats follows from how often each channel repeats by itself.

The study interpolates them. What that is worth is measured: the smooth motion is read with its repeats taken
for measurements. Where they would hardly change the residual, they are a note on the log (its defect
`repeated_rows`) and no finding.
"""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from ...arrays import JointSeries, JointVector, SampleMask, Samples
from ...dynamics.prediction import Prediction
from ...log.model import LogRows
from ...numerics.distributions import poisson_at_least
from ...signals.condition import Motion
from ...signals.resample import dropped_mask
from ..dataset.dataset import Dataset
from ..thresholds.checks import ALTERNATIVES
from ..thresholds.dataset import SAMPLE_CHECKS
from .protocol import Quantity, number_text
from .sample_check import Corruption, SampleCheck, SampleFinding, disturbance, over_residual, residual_share

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
        p_value = poisson_at_least(lost, expected) if lost else 1.0
        if p_value > SAMPLE_CHECKS.level:
            return ()
        fraction = lost / rows
        deviation = float(np.sqrt(fraction * (1.0 - fraction) / rows))
        kept = _share_if_kept(dataset, operating_point, fraction)
        worst = int(np.argmax(kept))
        if np.sqrt(1.0 + kept[worst]) < 1.0 + 0.01 * ALTERNATIVES.least_gain:
            return ()
        return (
            SampleFinding(
                site=(),
                quantities=(Quantity("fraction", None, "1", fraction, deviation),),
                statement=(
                    f"Dropped samples: {lost} of {rows} rows ({100.0 * fraction:.3g} %) repeat all positions "
                    "and torques of the row before while the robot moves; they are left out and "
                    "interpolated. Taken for measurements they would leave "
                    f"{percent_more(kept[worst])} more RMS error on joint {worst + 1}"
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
    channels = (rows.position, rows.current if rows.torque is None else rows.torque)
    columns = [column for channel in channels if channel is not None for column in channel.T]
    return _Count(int(moving.sum()), int(lost.sum()), _expected(columns, moving, lost))


def _expected(columns: list[Samples], moving: SampleMask, lost: SampleMask) -> float:
    """Give how many rows repeat by chance while the robot moves, from how often each channel does nearby.

    Coarse channels repeat together where all joints are slow. Where the robot starts or stops this is so for
    a few rows only, and the rows beside them tell it, those at rest among them. Rows in which all repeat are
    not counted, so that a channel repeats more often than in those that are: by the chance that all do.
    """
    wide, beside = SAMPLE_CHECKS.dropped_nearby // 2, SAMPLE_CHECKS.dropped_reach
    known, near = 1.0 + _nearby(moving & ~lost, wide), np.maximum(_nearby(~lost, beside), 1.0)
    shares = []
    for column in columns:
        same = np.append(False, column[1:] == column[:-1]) & ~lost
        shares.append(np.maximum((_nearby(same & moving, wide) + 0.5) / known, _nearby(same, beside) / near))
    chances = np.zeros(len(moving))
    for _ in range(SAMPLE_CHECKS.dropped_rounds):
        chances = np.prod([share * (1.0 - chances) + chances for share in shares], axis=0)
    return float(chances[moving].sum())


def _nearby(marks: SampleMask, reach: int) -> Samples:
    """Count marks among the rows up to so many before and after each row."""
    counts, rows = np.append(0, np.cumsum(marks)), np.arange(len(marks))
    count = counts[np.minimum(rows + reach + 1, len(marks))] - counts[np.maximum(rows - reach, 0)]
    return np.asarray(count, dtype=float)


def percent_more(share: float) -> str:
    """Write by how much an added share of its mean square raises an RMS.

    Examples
    --------
    >>> percent_more(0.21), percent_more(8.0)
    ('10 %', '200 %')
    """
    return f"{number_text(100.0 * float(np.sqrt(1.0 + share) - 1.0), 2)} %"


def _share_if_kept(dataset: Dataset, operating_point: Prediction, fraction: float) -> JointVector:
    """Give, per joint, the mean square that repeats add if taken for measurements, over the residual's.

    Few repeats are too few to draw from: what they add grows with their number while they are rare.
    """
    drawn = max(fraction, SAMPLE_CHECKS.dropped_drawn)
    added = disturbance(dataset, operating_point, _repeated(drawn))
    return fraction / drawn * over_residual(dataset, operating_point, added)


def _repeated(fraction: float) -> Corruption:
    """Repeat the row before in the place of a share of rows of a smooth motion."""

    def corrupt(position: JointSeries, velocity: JointSeries, rng: np.random.Generator) -> JointSeries:
        del velocity
        lost = rng.random(len(position)) < fraction
        kept = np.maximum.accumulate(np.where(lost, 0, np.arange(len(lost))))
        return np.asarray(position[kept] - position)

    return corrupt


def _bridged(fraction: float) -> Corruption:
    """Leave out the same share of rows of a smooth motion and interpolate them, as the study does."""

    def corrupt(position: JointSeries, velocity: JointSeries, rng: np.random.Generator) -> JointSeries:
        del velocity
        index = np.arange(len(position))
        kept = rng.random(len(position)) >= fraction
        kept[[0, -1]] = True
        return np.asarray(CubicSpline(index[kept], position[kept])(index) - position)

    return corrupt
