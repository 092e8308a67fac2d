"""Find torque channels that may cut off what is below their step, as conversion to an integer does.

All values of such a channel are multiples of its step, zero among them. Rounding errs to either side. Cutting
takes half a step on average, always toward zero, which looks like friction that grows with the load, and it
gives twice as many zeros as rounding does.
"""

from collections.abc import Iterator
from itertools import product

import numpy as np

from ...arrays import JointSeries, Samples
from ...numerics.distributions import normal_tail
from ...numerics.marked_runs import marked_runs
from ...signals.dead_zone import DeadZone
from ..causes.torque_dead_zone import logged_efforts
from ..dataset.dataset import Dataset
from ..thresholds.dataset import SAMPLE_CHECKS


def cut_channels(dataset: Dataset, residual: JointSeries) -> Iterator[DeadZone]:
    """Find the channels of every log that seem to cut off torques, by so much that it matters.

    Parameters
    ----------
    residual
        Measured minus predicted torque at the data set's rows, N m or N.
    """
    for number, joint in product(range(len(dataset.motions)), range(dataset.joints)):
        own = residual[(dataset.log == number) & dataset.usable[:, joint], joint]
        zone = _zone(dataset, number, joint)
        if zone is not None and len(own):
            scatter = float(np.sqrt(np.mean(own**2) / len(own)))
            if zone.shortfall > SAMPLE_CHECKS.dead_clearness * scatter:
                yield zone


def _zone(dataset: Dataset, number: int, joint: int) -> DeadZone | None:
    """Give what a channel with steps may cut off: nearer to twice as many zeros than to as many as beside."""
    efforts, moving = logged_efforts(dataset, number, joint)
    step = _step(efforts)
    if step is None:
        return None
    levels = np.abs(np.round(np.where(moving, efforts, np.nan) / step))
    zeros, beside, others = (int(np.sum(which)) for which in (levels == 0.0, levels == 1.0, levels > 0.0))
    ratio = zeros / max(0.5 * beside, 1.0)
    if ratio < SAMPLE_CHECKS.cut_zeros or others < SAMPLE_CHECKS.dead_nearby * zeros:
        return None
    scatter = SAMPLE_CHECKS.cut_scatter / np.sqrt(len(marked_runs(levels == 0.0)))
    chance = normal_tail((ratio - 1.0) / scatter)
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
