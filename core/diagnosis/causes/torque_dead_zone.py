"""Candidate cause: a dead zone of a torque channel, within which small torques read exactly zero.

Noise hardly ever gives one value twice, and rounding gives its neighbours as often. So a zero that occurs far
more often than any other value next to it, while the joint moves, is not measured. A recorder that writes
zero where it has nothing does so next to torques of any size, a dead zone next to small ones. Torques are as
dense within the zone as beside it: as many nonzero ones as there are zeros fill as wide a range. A channel
that cuts off what is below its step, as conversion to an integer does, has a zone of one step to either side.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from ...arrays import JointSeries, JointVector, SampleMask, Samples
from ...dynamics.prediction import Prediction
from ...numerics.distributions import poisson_at_least
from ...numerics.marked_runs import marked_runs
from ...robot.joint_units import joint_unit
from ...signals.dead_zone import DeadZone
from ...signals.resample import effort_of
from ..dataset.dataset import Dataset
from ..thresholds.dataset import ROWS, SAMPLE_CHECKS
from .protocol import Quantity, number_text
from .sample_check import SampleCheck, SampleFinding, followed_share, share_of_residual


@dataclass(frozen=True)
class TorqueDeadZone(SampleCheck):
    """Candidate cause: a dead zone of a torque channel."""

    id = "torque_dead_zone"
    title = "Dead zone of the torque channel"
    units = (("half_width", "N m"),)
    experiment = "slow motion through postures in which the torque changes its sign"
    beyond_repair = "What the channel kept back of the torque is not in the log"

    def examine(self, dataset: Dataset, operating_point: Prediction) -> tuple[SampleFinding, ...]:
        """Count zeros of every channel while its joint moves."""
        return zone_findings(dataset, operating_point, dead_zones(dataset))


def zone_findings(
    dataset: Dataset, operating_point: Prediction, zones: Sequence[DeadZone], *, stay: bool = False
) -> tuple[SampleFinding, ...]:
    """State the widest zone of every channel, and the share of the residual that it accounts for.

    Parameters
    ----------
    stay
        Whether they stay in the torques: then all that a zone adds counts, also what a fit takes up.
    """
    widest = {zone.joint: zone for zone in sorted(zones, key=lambda zone: zone.half)}
    share_of = share_of_residual if stay else followed_share
    added = {zone: _added(dataset, operating_point, zone) for zone in widest.values()}
    return tuple(
        _finding(dataset, zone, share_of(dataset, operating_point, own)) for zone, own in added.items()
    )


def dead_zones(dataset: Dataset) -> tuple[DeadZone, ...]:
    """Find the dead zones of the channels of every log."""
    asked = product(range(len(dataset.motions)), range(dataset.joints))
    known = (_zone(dataset, log, joint) for log, joint in asked)
    return tuple(zone for zone in known if zone is not None)


def _zone(dataset: Dataset, number: int, joint: int) -> DeadZone | None:
    """Find the dead zone of a channel in one log."""
    effort, moving = logged_efforts(dataset, number, joint)
    zero = moving & (effort == 0.0)
    zeros, others = int(zero.sum()), effort[moving & (effort != 0.0)]
    runs = marked_runs(zero)
    if len(runs) < SAMPLE_CHECKS.dead_passages or len(others) < SAMPLE_CHECKS.dead_nearby * zeros:
        return None
    sizes = np.sort(np.abs(others))
    near = others[np.abs(others) <= sizes[zeros - 1]]
    most = int(np.unique(near, return_counts=True)[1].max())
    # Where the joint turns round its friction jumps: beside one end of a stretch the torque may be large.
    ends = effort[np.stack([np.maximum(runs[:, 0] - 1, 0), np.minimum(runs[:, 1], len(effort) - 1)])]
    beside = float(np.quantile(np.abs(ends).min(axis=0), SAMPLE_CHECKS.dead_flanks))
    small = beside < SAMPLE_CHECKS.dead_flank * np.median(sizes)
    p_value = poisson_at_least(zeros, most)
    if zeros < SAMPLE_CHECKS.dead_over_others * most or not small or p_value > SAMPLE_CHECKS.level:
        return None
    gap, width = float(sizes[0]), float(sizes[zeros - 1] - sizes[0])
    shrinks = gap < SAMPLE_CHECKS.dead_gap * width
    half = width if shrinks else gap
    # How dense torques are changes with their size: by how much, the next as many show.
    next_width = float(sizes[min(2 * zeros, len(sizes)) - 1] - sizes[zeros - 1])
    scatter = half * float(np.sqrt(2.0 / len(runs)))
    # The least of torques that lie so densely is one distance off the edge, by the exponential law.
    deviation = float(np.hypot(scatter, next_width - width)) if shrinks else width / zeros
    share = zeros / (zeros + len(others))
    shortfall = half if shrinks else 0.0
    return DeadZone(number, joint, half, deviation, shortfall, zeros, share, max(p_value, 1e-300))


def logged_efforts(dataset: Dataset, number: int, joint: int) -> tuple[Samples, SampleMask]:
    """Give a joint's torques in a log as they were logged, over its beginning, and mark where it moves."""
    motion, own = dataset.motions[number], dataset.log == number
    log = motion.log
    rows = log.source.rows(0, min(log.source.samples, int(ROWS.seconds * log.rate_hz)))
    speed = np.interp(rows.time, dataset.time[own], np.abs(dataset.state.velocity[own, joint]))
    return effort_of(rows)[:, joint] * motion.effort_scale[joint], speed > motion.recipe.still_speed[joint]


def _finding(dataset: Dataset, zone: DeadZone, share: JointVector) -> SampleFinding:
    joint = zone.joint + 1
    unit = joint_unit(dataset.robot, joint, "N m")
    size = Quantity("half_width", joint, unit, zone.half, zone.deviation)
    return SampleFinding(
        site=(joint,),
        quantities=(size,),
        statement=(
            f"{_said(zone, size)}; {zone.zeros} samples in motion, {100.0 * zone.share:.2g} %, "
            "are exactly zero"
        ),
        statistic=float(zone.zeros),
        p_value=zone.p_value,
        residual_share=share,
    )


def _said(zone: DeadZone, size: Quantity) -> str:
    """Say what the channel does with small torques and with larger ones."""
    channel, step = f"orque channel {size.joint}", f"{number_text(size.value, 3)} {size.unit}"
    if zone.cuts_off and zone.is_known:
        return f"T{channel} cuts off what is below its step of {step}, half a step on average"
    if zone.cuts_off:
        return f"T{channel} may cut off what is below its step of {step}: the motion does not tell"
    larger = "too little by as much" if zone.shortfall else "what they are"
    return f"Dead zone of t{channel}: torques below {size.text} read zero, and larger ones {larger}"


def _added(dataset: Dataset, operating_point: Prediction, zone: DeadZone) -> JointSeries:
    """Give what the zone adds to the predicted torque at the data set's rows."""
    added = np.zeros_like(dataset.torque)
    for stretch in dataset.stretches:
        error = np.zeros_like(stretch.state.position)
        error[:, zone.joint] = zone.error(operating_point.torque(stretch.state)[:, zone.joint])
        added[stretch.rows] = stretch.filtered(error.T).T
    return added
