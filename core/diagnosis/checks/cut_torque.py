"""Find torque channels that may cut off what is below their step, as conversion to an integer does.

All values of such a channel are multiples of its step, zero among them. Rounding errs to either side. Cutting
takes half a step on average, always toward zero, which looks like friction that grows with the load, and it
gives twice as many zeros as rounding does.
"""

from collections.abc import Iterator

import numpy as np

from ...arrays import JointSeries, Samples
from ...numerics.distributions import normal_tail
from ...numerics.marked_runs import marked_runs
from ...signals.dead_zone import DeadZone
from ..causes.torque_dead_zone import logged_efforts
from ..dataset.dataset import Dataset
from ..thresholds.dataset import SAMPLE_CHECKS


def cut_channels(dataset: Dataset, residual: JointSeries) -> Iterator[DeadZone]:
    """Find the channels that may cut off torques, by so much that it matters.

    The channels of a log come from one recorder. So all those with steps are asked where one seems to cut.

    Parameters
    ----------
    residual
        Measured minus predicted torque at the data set's rows, N m or N.
    """
    for number in range(len(dataset.motions)):
        asked = (_zone(dataset, number, joint) for joint in range(dataset.joints))
        zones = [zone for zone in asked if zone is not None and _matters(zone, dataset, residual)]
        if any(zone.p_value < 1.0 for zone in zones):
            yield from zones


def _matters(zone: DeadZone, dataset: Dataset, residual: JointSeries) -> bool:
    """Tell whether what a zone takes from larger torques shows in what a model leaves."""
    own = residual[(dataset.log == zone.log) & dataset.usable[:, zone.joint], zone.joint]
    return zone.shortfall > SAMPLE_CHECKS.dead_clearness * float(np.sqrt(np.sum(own**2)) / max(len(own), 1))


def _zone(dataset: Dataset, number: int, joint: int) -> DeadZone | None:
    """Give what a channel with steps takes from torques if it cuts off; None without steps.

    Its p-value is 1 where it has hardly more zeros than rounding gives: not more than of values next to it.
    """
    efforts, moving = logged_efforts(dataset, number, joint)
    step = _step(efforts)
    if step is None:
        return None
    levels = np.abs(np.round(np.where(moving, efforts, np.nan) / step))
    zeros, others = int(np.sum(levels == 0.0)), int(np.sum(levels > 0.0))
    # Where coarse torques were interpolated, every other value is rare.
    beside = max(int(np.sum(levels == level)) for level in (1.0, 2.0))
    if others < max(SAMPLE_CHECKS.dead_nearby * zeros, 1.0):
        return None
    ratio = zeros / max(0.5 * beside, 1.0)
    scatter = SAMPLE_CHECKS.cut_scatter / np.sqrt(max(len(marked_runs(levels == 0.0)), 1))
    chance = normal_tail((ratio - 1.0) / scatter) if ratio > SAMPLE_CHECKS.cut_zeros else 1.0
    return DeadZone(number, joint, step, 0.0, 0.5 * step, zeros, zeros / (zeros + others), chance)


def _step(efforts: Samples) -> float | None:
    """Give the step of which all torques are multiples, N m or N; None where they are not."""
    sizes = np.unique(np.abs(efforts))
    if len(sizes) < SAMPLE_CHECKS.cut_levels or sizes[0] > 0.0:
        return None
    step, known = float(sizes[1]), 2
    # The least is rounded. The larger a multiple, the better it tells the step.
    while known < len(sizes):
        known = min(2 * known, len(sizes))
        levels = np.round(sizes[:known] / step)
        step = float(levels @ sizes[:known] / (levels @ levels))
        if np.abs(sizes[:known] - levels * step).max() > SAMPLE_CHECKS.cut_exactness * step:
            return None
    return step
