"""Find torque channels that read no more than a limit while the motion asks for more.

A channel at its limit reads one value over and over. The drive may be at its limit as well, and then the
motion shows that value, too. No fit uses these rows. Where the model predicts more at them, the channel lost
it.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...arrays import SampleMask
from ...dynamics.prediction import Prediction
from ...log.model import JointLog
from ...numerics.distributions import normal_tail
from ...robot.joint_units import joint_unit
from ...signals.marks import at_limit
from ..causes.protocol import Quantity, number_text
from ..causes.sample_check import SampleFinding
from ..causes.torque_saturation import TorqueSaturation
from ..dataset.dataset import Dataset
from ..regression.innovation_covariance import torque_residual
from ..thresholds.dataset import SAMPLE_CHECKS

ROWS = 65_536


@dataclass(frozen=True)
class ClippedChannel(TorqueSaturation):
    """Name a clipped channel: a torque limit of the log, not of the drive."""

    title: ClassVar[str] = "Torque saturation of the channel: the log is clipped"


@dataclass(frozen=True, eq=False)
class _Limit:
    """Hold a joint (from 0), the limit with its sign (N m or N), and the rows of the data set at it."""

    joint: int
    level: float
    rows: SampleMask


def clipped_channels(dataset: Dataset, operating_point: Prediction) -> tuple[SampleFinding, ...]:
    """Give every limit of a channel beyond which a model predicts torque."""
    residual = torque_residual(dataset, operating_point)
    judged = (_judged(dataset, limit, residual[:, limit.joint]) for limit in _limits(dataset))
    return tuple(finding for finding in judged if finding is not None)


def _limits(dataset: Dataset) -> Iterator[_Limit]:
    """Give the limits that some log stays at."""
    for number, motion in enumerate(dataset.motions):
        own = dataset.log == number
        for defect in motion.log.defects:
            if defect.kind != "saturation" or defect.level is None or defect.joint is None:
                continue
            joint = defect.joint - 1
            moving = np.abs(dataset.state.velocity[:, joint]) > motion.recipe.still_speed[joint]
            rows = np.zeros(len(dataset.time), dtype=bool)
            rows[own] = _at_level(motion.log, joint, defect.level, dataset.time[own])
            yield _Limit(joint, defect.level, rows & moving & _settled(dataset, joint))


def _at_level(log: JointLog, joint: int, level: float, time: np.ndarray) -> SampleMask:
    """Mark the instants at which the channel is at a level, before and after."""
    stamps, there = [], []
    for begin in range(0, log.source.samples, ROWS):
        rows = log.source.rows(begin, begin + ROWS)
        if rows.torque is not None:
            stamps.append(rows.time)
            there.append(at_limit(rows.torque[:, joint], level))
    return np.asarray(np.interp(time, np.concatenate(stamps), np.concatenate(there).astype(float)) >= 1.0)


def _settled(dataset: Dataset, joint: int) -> SampleMask:
    """Mark the rows between the first and the last that a fit may use, stretch by stretch."""
    marks = np.zeros(len(dataset.time), dtype=bool)
    for stretch in dataset.stretches:
        usable = stretch.rows.start + np.flatnonzero(dataset.usable[stretch.rows, joint])
        if len(usable):
            marks[usable[0] : usable[-1]] = True
    return marks


def _judged(dataset: Dataset, limit: _Limit, left: np.ndarray) -> SampleFinding | None:
    """Compare what the model predicts beyond a limit with what it leaves elsewhere."""
    elsewhere = dataset.usable[:, limit.joint] & ~limit.rows
    rows = np.flatnonzero(limit.rows)
    if not len(rows) or not elsewhere.any():
        return None
    runs = [run for run in np.split(rows, np.flatnonzero(~dataset.follows(rows))) if len(run)]
    beyond = -np.sign(limit.level) * left[rows]
    # Within a run the noise may be all the same; the longer a run is, the more the channel lost.
    spread = np.sqrt(np.sum([float(len(run)) ** 2 for run in runs]) * np.mean(left[elsewhere] ** 2))
    statistic = float(np.sum(beyond) / max(spread, 1e-300))
    p_value = normal_tail(statistic)
    if p_value > SAMPLE_CHECKS.level:
        return None
    share = np.zeros(dataset.joints)
    share[limit.joint] = np.sum(left[rows] ** 2) / (np.sum(left[rows] ** 2) + np.sum(left[elsewhere] ** 2))
    unit = joint_unit(dataset.robot, limit.joint + 1, "N m")
    return SampleFinding(
        site=(limit.joint + 1,),
        quantities=(Quantity("limit", limit.joint + 1, unit, abs(limit.level), 0.0),),
        statement=(
            f"Torque saturation on joint {limit.joint + 1}: the log is clipped at "
            f"{number_text(limit.level, 4)} {unit}, where the model, fitted without these rows, predicts "
            f"{number_text(float(np.mean(beyond)), 2)} {unit} more on average"
        ),
        statistic=statistic,
        p_value=max(p_value, 1e-300),
        residual_share=share,
    )
