"""Build the data set of a diagnosis: filtered rows of a wider band than the fit's, kept in memory.

An identification filters as low as the motion allows. A diagnosis needs the content above (gear ripple,
compliance, delays), so its parallel filter passes twenty times the motion's bandwidth, a twelfth of the rate
at most. Rows within the filter's main lobe of a velocity reversal are marked: there the sign of a measured
velocity is not the direction of friction. Of long logs evenly spread stretches are used.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np
from scipy.sparse import block_diag, csr_array

from ...arrays import BlockKey, Indices, JointMask, JointSeries, Samples, UsableRows
from ...dynamics.model import DynamicModel
from ...dynamics.term import Term
from ...errors import ExcitationError
from ...log.model import JointLog
from ...regressor.columns import ColumnPlan
from ...robot.joint_units import prismatic_joints
from ...robot.model import RobotModel
from ...signals.condition import Motion, condition
from ...signals.dead_zone import DeadZone, unread, with_restored_torque, zones_of
from ...signals.recipe import FilterOptions, choose_recipe
from ...signals.state import MotionState, concatenate_states
from ..thresholds.dataset import BAND, ROWS
from .columns import term_columns
from .segments import DatasetSegment, later_torques, segments_of, thinning, torque_signs
from .stretch import Stretch


@dataclass(frozen=True, eq=False)
class Dataset:
    """Hold the rows of a diagnosis."""

    robot: RobotModel
    """The robot as described."""
    motions: tuple[Motion, ...]
    stretches: tuple[Stretch, ...]
    time: Samples
    log: Indices
    block: Indices
    """Per row: instant in s, number of the log and of its block, from 0."""
    torque: JointSeries
    """Filtered torque, rows x joints."""
    usable: JointMask
    """Rows that may be used per joint, and those of them clear of reversals (`clear`)."""
    clear: JointMask
    held_out: np.ndarray
    """Held-out rows, which no fit uses."""
    state: MotionState
    """The motion at the rows."""
    sticking: tuple[csr_array, ...]
    """Per joint, nuisance columns: any friction while the joint is practically at rest."""
    band_hz: float
    motion_band_hz: float
    width: float
    """Cut-off of the parallel filter, that of the motion, and the ratio of the two that was asked for."""
    position_torque: JointSeries
    """One draw of the torque error that such noise causes: rows x joints, N m or N."""

    @property
    def joints(self) -> int:
        """Count the joints."""
        return int(self.torque.shape[1])

    @cached_property
    def starts(self) -> np.ndarray:
        """Mark the rows that do not follow the one before them."""
        marks = np.zeros(len(self.time), dtype=bool)
        marks[[stretch.rows.start for stretch in self.stretches]] = True
        return marks

    def follows(self, rows: Indices) -> UsableRows:
        """Mark which of some rows follow the one before them without a gap."""
        return np.asarray((np.diff(rows, prepend=-2) == 1) & ~self.starts[rows])

    @property
    def block_of_all(self) -> np.ndarray:
        """Number the blocks of all logs through, one number per row."""
        return np.asarray(self.log * (1 + self.block.max()) + self.block)

    @property
    def held_out_blocks(self) -> frozenset[BlockKey]:
        """Name the held-out blocks."""
        keys = np.unique(np.column_stack([self.log, self.block])[self.held_out], axis=0)
        return frozenset((int(log), int(block)) for log, block in keys)

    @cached_property
    def speed(self) -> np.ndarray:
        """Give the RMS speed per joint, rad/s or m/s."""
        return np.asarray(np.sqrt(np.mean(self.state.velocity**2, axis=0)))

    def observed(self, plan: ColumnPlan) -> tuple[np.ndarray, ...]:
        """Give, per joint, the filtered rows over all columns of a plan (zeros where none)."""
        out = [np.zeros((len(self.time), len(plan.columns))) for _ in range(self.joints)]
        for stretch in self.stretches:
            filtered = stretch.filtered(plan.series(stretch.state))
            for joint, (rows, columns) in enumerate(zip(plan.rows_of, plan.columns_of, strict=True)):
                out[joint][stretch.rows, columns] = filtered[rows].T
        return tuple(out)

    def columns(self, terms: Sequence[Term]) -> list[dict[int, np.ndarray]]:
        """Give, per term and joint (from 0), the filtered rows per unit parameter."""
        return term_columns(terms, self.robot, self.stretches, len(self.time))


def build_dataset(
    model: DynamicModel,
    logs: tuple[JointLog, ...],
    *,
    held_out: frozenset[BlockKey],
    blocks: int,
    width: float = BAND.over_motion,
    zones: Sequence[DeadZone] = (),
) -> Dataset:
    """Condition the logs for a diagnosis.

    Parameters
    ----------
    held_out
        (log, block) pairs that are only predicted, never fitted.
    blocks
        Number of blocks each log is divided into.
    width
        Ratio of the data set's band to the motion's.
    zones
        Dead zones of torque channels: what they take is added, and rows within are not used.

    Raises
    ------
    ExcitationError
        If no row is left.
    """
    motions = tuple(
        condition(
            with_restored_torque(log, model.robot, zones_of(zones, number)),
            model.robot,
            _options(log, width, model.robot),
            blocks=blocks,
            number=number,
        )
        for number, log in enumerate(logs)
    )
    parts = _segments(motions, model.robot, [log.duration for log in logs])
    series = _concatenate_series(parts)
    read = _read_rows(parts, logs, motions, zones)
    series |= {name: series[name] & read for name in ("usable", "clear")}
    keys = {log * blocks + block for log, block in held_out}
    return Dataset(
        robot=model.robot,
        motions=motions,
        stretches=_place_stretches(parts),
        **series,
        held_out=np.isin(series["log"] * blocks + series["block"], sorted(keys)),
        state=concatenate_states([part.state for part in parts]),
        sticking=_join_sticking(parts),
        band_hz=max(motion.recipe.cutoff_hz for motion in motions),
        motion_band_hz=max(motion.recipe.motion_band_hz for motion in motions),
        width=width,
        position_torque=np.zeros_like(series["torque"]),
    )


def identification_width(dataset: Dataset) -> float:
    """Give the ratio of an identification's band to the motion's, which noise of positions narrows."""
    prismatic = prismatic_joints(dataset.robot)
    recipes = [choose_recipe(motion.log, FilterOptions(), prismatic) for motion in dataset.motions]
    return min(recipe.cutoff_hz / recipe.motion_band_hz for recipe in recipes)


def drowning_width(dataset: Dataset) -> float:
    """Give the ratio of the band beyond which noise of the positions drowns the motion to the motion's."""
    recipes = [motion.recipe for motion in dataset.motions]
    return BAND.drowned * min(recipe.outweighed_hz / recipe.motion_band_hz for recipe in recipes)


def later_torque(dataset: Dataset, seconds: float) -> JointSeries:
    """Give a data set's torque, taken so many seconds later: rows x joints, N m or N."""
    return _of_motions(dataset, partial(later_torques, seconds=seconds))


def torque_sign(dataset: Dataset) -> JointSeries:
    """Give the sign of a data set's torque, filtered as the torque is: rows x joints."""
    return _of_motions(dataset, torque_signs)


def _of_motions(dataset: Dataset, series: Callable[[Motion, float], list[JointSeries]]) -> JointSeries:
    share = _share([motion.log.duration for motion in dataset.motions])
    return np.vstack([part for motion in dataset.motions for part in series(motion, share)])


def _share(seconds: list[float]) -> float:
    """Give the share of logs of so many seconds that a data set may hold."""
    return min(1.0, ROWS.seconds / sum(seconds))


def _segments(motions: Sequence[Motion], robot: RobotModel, seconds: list[float]) -> list[DatasetSegment]:
    """Cut all motions into segments, as many as the data set may hold of logs of so many seconds."""
    share = _share(seconds)
    parts = [part for log, motion in enumerate(motions) for part in segments_of(log, motion, robot, share)]
    if not parts:
        raise ExcitationError(
            "no stretch of the logs is long enough to be diagnosed",
            evidence={"seconds": seconds},
            remedy="record at least ten seconds of motion",
        )
    return parts


def _concatenate_series(parts: Sequence[DatasetSegment]) -> dict[str, np.ndarray]:
    """Give every row's time, log, block, torque and masks, segments one after the other."""
    return {
        "time": np.concatenate([part.time for part in parts]),
        "log": np.concatenate([np.full(len(part.time), part.log) for part in parts]),
        "block": np.concatenate([part.block for part in parts]),
        "torque": np.vstack([part.torque for part in parts]),
        "usable": np.vstack([part.usable for part in parts]),
        "clear": np.vstack([part.usable & part.clear for part in parts]),
    }


def _read_rows(
    parts: Sequence[DatasetSegment],
    logs: Sequence[JointLog],
    motions: Sequence[Motion],
    zones: Sequence[DeadZone],
) -> JointMask:
    """Mark the rows of all segments, per joint, in which no torque is mixed that a channel read as zero."""
    lobes = [1.0 / motion.recipe.cutoff_hz for motion in motions]  # a main lobe's width is a period
    marks = [unread(logs[own.log], zones_of(zones, own.log), own.time, lobes[own.log]) for own in parts]
    return ~np.vstack(marks)


def _join_sticking(parts: Sequence[DatasetSegment]) -> tuple[csr_array, ...]:
    of_joints = zip(*(part.sticking for part in parts), strict=True)
    return tuple(block_diag(of_joint, format="csr") for of_joint in of_joints)


def _place_stretches(parts: Sequence[DatasetSegment]) -> tuple[Stretch, ...]:
    """Give the segments' stretches with the rows of the data set that they fill."""
    rows = np.cumsum([0] + [len(part.time) for part in parts])
    return tuple(
        replace(part.stretch, rows=slice(int(start), int(stop)))
        for part, start, stop in zip(parts, rows[:-1], rows[1:], strict=True)
    )


def _options(log: JointLog, width: float, robot: RobotModel) -> FilterOptions:
    """Choose the bandwidth of a diagnosis from the motion's own, and rows that fall on thinned states.

    Absurd positions are replaced only where the log is known to have some.
    """
    band = choose_recipe(log, FilterOptions(), prismatic_joints(robot)).motion_band_hz
    cutoff = min(width * band, log.rate_hz / BAND.rate)
    thin = thinning(log.rate_hz, cutoff)
    spiky = any((defect.kind, defect.channel) == ("outliers", "position") for defect in log.defects)
    return FilterOptions(
        median_order=FilterOptions.median_order if spiky else 1,
        cutoff_hz=cutoff,
        position_cutoff_hz=min(BAND.position * cutoff, BAND.position_over_rate * log.rate_hz),
        order=BAND.order,
        decimation=thin * int(log.rate_hz / (BAND.rows * cutoff) / thin),
    )
