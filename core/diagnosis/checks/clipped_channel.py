"""Find torque channels that read no more than a limit while the motion asks for more.

A channel at its limit reads one value over and over. The drive may be at its limit as well, and then the
motion shows that value, too. Where a model that is fitted without these rows predicts more, the channel lost
it.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from scipy.stats import norm

from ...arrays import SampleMask
from ...log.model import JointLog
from ...robot.joint_units import joint_unit
from ..causes.protocol import Quantity, number_text
from ..causes.sample_check import SampleFinding
from ..causes.torque_saturation import TorqueSaturation
from ..dataset.dataset import Dataset
from ..regression.innovation_covariance import torque_residual
from ..thresholds.dataset import SAMPLE_CHECKS
from .holdout_outliers import Explained

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


def clipped_channels(dataset: Dataset, fitted: Callable[[Dataset], Explained]) -> tuple[SampleFinding, ...]:
    """Give every limit of a channel beyond which a model predicts torque.

    Parameters
    ----------
    fitted
        Fits the model to a data set: gives a fitter and its fit.
    """
    findings = []
    for limit in _limits(dataset):
        fitter, found = fitted(_without(dataset, limit))
        left = torque_residual(dataset, fitter.linearised_at(found).operating_point)[:, limit.joint]
        finding = _judged(dataset, limit, left)
        if finding is not None:
            findings.append(finding)
    return tuple(findings)


def _without(dataset: Dataset, limit: _Limit) -> Dataset:
    """Leave the rows at a limit to no fit."""
    at_limit = limit.rows[:, None] & (np.arange(dataset.joints) == limit.joint)
    return replace(dataset, usable=dataset.usable & ~at_limit, clear=dataset.clear & ~at_limit)


def _limits(dataset: Dataset) -> Iterator[_Limit]:
    """Give the limits that some log stays at."""
    for joint, sign in sorted({one for motion in dataset.motions for one in _clipped(motion.log)}):
        levels = [_level(motion.log, joint, sign) for motion in dataset.motions]
        level = max(levels)
        rows = np.zeros(len(dataset.time), dtype=bool)
        for number, motion in enumerate(dataset.motions):
            own = dataset.log == number
            if levels[number] == level:
                rows[own] = _at_level(motion.log, joint, sign, level, dataset.time[own])
        yield _Limit(joint, sign * level, rows & dataset.usable[:, joint])


def _clipped(log: JointLog) -> Iterator[tuple[int, float]]:
    """Give joint (from 0) and sign of every torque that a log stays at."""
    for defect in log.defects:
        if (defect.kind, defect.channel) == ("saturation", "torque") and defect.joint is not None:
            highest, lowest = (_level(log, defect.joint - 1, sign) for sign in (1.0, -1.0))
            yield defect.joint - 1, 1.0 if highest > lowest else -1.0


def _level(log: JointLog, joint: int, sign: float) -> float:
    return max(float((sign * torque).max()) for _, torque in _torques(log, joint))


def _torques(log: JointLog, joint: int) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Give stamps and torques of a joint, many rows at a time."""
    for begin in range(0, log.source.samples, ROWS):
        rows = log.source.rows(begin, begin + ROWS)
        if rows.torque is not None:
            yield rows.time, rows.torque[:, joint]


def _at_level(log: JointLog, joint: int, sign: float, level: float, time: np.ndarray) -> SampleMask:
    """Mark the instants at which the channel is at a level, before and after."""
    stamps, torques = (np.concatenate(one) for one in zip(*_torques(log, joint), strict=True))
    return np.asarray(np.interp(time, stamps, (sign * torques >= level).astype(float)) >= 1.0)


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
    p_value = float(norm.sf(statistic))
    if p_value > SAMPLE_CHECKS.level:
        return None
    share = np.zeros(dataset.joints)
    share[limit.joint] = np.sum(left[rows] ** 2) / np.sum(left[dataset.usable[:, limit.joint]] ** 2)
    unit = joint_unit(dataset.robot, limit.joint + 1, "N m")
    return SampleFinding(
        site=(limit.joint + 1,),
        quantities=(Quantity("limit", limit.joint + 1, unit, abs(limit.level), 0.0),),
        statement=(
            f"Torque saturation on joint {limit.joint + 1}: the log is clipped at "
            f"{number_text(limit.level, 4)} {unit}, where a model fitted without these rows predicts "
            f"{number_text(float(np.mean(beyond)), 2)} {unit} more on average"
        ),
        statistic=statistic,
        p_value=max(p_value, 1e-300),
        residual_share=share,
    )
