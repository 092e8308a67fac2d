"""Cut a conditioned log into the segments that a diagnosis keeps in memory, with their filtered rows.

States are decimated as far as the parallel filter's bandwidth allows. Rows near a velocity reversal are
marked: there the sign of a measured velocity is not the direction of friction.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_array

from ...arrays import Indices, JointMask, JointSeries
from ...log.model import JointLog
from ...log.shifted import with_later_effort
from ...robot.model import RobotModel
from ...signals.condition import Motion
from ...signals.segment import Segment
from ...signals.state import MotionState
from ..thresholds.dataset import BAND, ROWS
from .stiction import rest_mask, stiction_columns
from .stretch import Stretch


@dataclass(frozen=True, eq=False)
class DatasetSegment:
    """Hold one segment of a log with what a data set keeps of its rows (see `Dataset`)."""

    log: int
    stretch: Stretch
    time: np.ndarray
    block: np.ndarray
    torque: np.ndarray
    usable: np.ndarray
    clear: np.ndarray
    state: MotionState
    sticking: tuple[csr_array, ...]


def segments_of(number: int, motion: Motion, robot: RobotModel, share: float) -> list[DatasetSegment]:
    """Cut a log into stretches of half a minute at most, and keep the share of them that is asked for."""
    return [
        _segment(number, motion, robot, segment, kept, done) for segment, kept, done in _spans(motion, share)
    ]


def later_torques(motion: Motion, share: float, seconds: float) -> list[JointSeries]:
    """Give the torques of `segments_of`, each row's taken so many seconds later."""
    log = with_later_effort(motion.log, seconds)
    return _of_torques(motion, log, share, lambda torque: torque)


def torque_signs(motion: Motion, share: float) -> list[JointSeries]:
    """Give the signs of the torques of `segments_of`, filtered as these are."""
    return _of_torques(motion, motion.log, share, np.sign)


def _of_torques(
    motion: Motion, log: JointLog, share: float, change: Callable[[JointSeries], JointSeries]
) -> list[JointSeries]:
    """Give what a change makes of a log's torques at the rows of a motion's `segments_of`."""
    out = []
    for segment, kept, _ in _spans(motion, share):
        effort, first = replace(segment, log=log).effort(*kept)
        series = np.ascontiguousarray(change(effort * motion.effort_scale).T)
        out.append(segment.parallel.apply(series, first, kept[1] - kept[0]).T)
    return out


def _spans(motion: Motion, share: float) -> Iterator[tuple[Segment, tuple[int, int], int]]:
    """Give each stretch that is kept: its part of the log, its decimated samples there, and those before."""
    done = 0
    for segment in motion.segments:
        step = segment.rate_hz / motion.recipe.decimation
        length = max(int(ROWS.stretch_seconds * step), 1)
        wanted = max(1, int(np.ceil(segment.kept * share / length)))
        size = min(segment.kept, int(np.ceil(segment.kept * share / wanted)))
        firsts = np.linspace(0, segment.kept - size, wanted).astype(int)
        for first in firsts:
            yield segment, (int(first), int(first) + size), done
        done += segment.kept


def _segment(
    number: int, motion: Motion, robot: RobotModel, segment: Segment, kept: tuple[int, int], done: int
) -> DatasetSegment:
    recipe, still = motion.recipe, motion.recipe.still_speed
    tile = segment.tile(motion.effort_scale, slice(*kept))
    thin = thinning(motion.log.rate_hz, recipe.cutoff_hz)
    begin = tile.first % thin
    state = tile.state.at(slice(begin, None, thin))
    at = tile.first + recipe.decimation * np.arange(len(tile.time))
    settled = _settled(at, len(tile.state.position), segment.rate_hz / recipe.cutoff_hz)
    fraction = (done + np.arange(*kept)) / motion.kept
    stretch = Stretch(
        state, tile.parallel.thinned(thin), (tile.first - begin) // thin, slice(0, len(tile.time))
    )
    return DatasetSegment(
        log=number,
        stretch=stretch,
        sticking=stiction_columns(stretch, rest_mask(state, robot, still), recipe.cutoff_hz),
        time=tile.time,
        block=np.minimum((fraction * motion.blocks).astype(int), motion.blocks - 1),
        torque=tile.filtered(np.ascontiguousarray(tile.torque.T)).T,
        usable=tile.usable & settled[:, None],
        clear=_clear(rest_mask(tile.state, robot, still), at, segment.rate_hz / recipe.cutoff_hz),
        state=tile.state.at(at),
    )


def thinning(rate_hz: float, cutoff_hz: float) -> int:
    """Say which of a log's samples are states: every n-th.

    Examples
    --------
    >>> thinning(1000.0, 20.0)
    6
    """
    return max(1, int(rate_hz / (BAND.states * cutoff_hz)))


def _settled(at: Indices, samples: int, period: float) -> np.ndarray:
    """Tell which decimated samples are so far from the ends of their stretch that filters have settled."""
    reach = int(np.ceil(ROWS.settling_periods * period))
    return np.asarray((at >= reach) & (at < samples - reach))


def _clear(turns: np.ndarray, at: Indices, period: float) -> JointMask:
    """Tell which decimated samples are further from every reversal than the filter's main lobe.

    The lobe is as long as a period of the cut-off, in samples.
    """
    reach = int(np.ceil(period))
    counts = np.cumsum(np.pad(turns, ((1, 0), (0, 0))), axis=0)
    low, high = np.maximum(at - reach, 0), np.minimum(at + reach + 1, len(turns))
    return np.asarray(counts[high] == counts[low])
