"""Give a log as it would have been without the faults that were found in its channels.

Rows are corrected as they are read, so that a log's length costs no memory here either. Every stretch between
gaps is corrected by itself; rows that stand for dropped samples go on repeating the row before.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields, replace
from itertools import pairwise

import numpy as np

from ..arrays import JointVector
from ..diagnosis.causes.registry import BY_ID
from ..diagnosis.causes.repairs import CorrectsLog
from ..errors import LogError
from ..log.model import JointLog, LogRows, rows_at
from ..robot.model import RobotModel
from ..signals.condition import effort_scale
from ..signals.resample import dropped_mask
from .repair import Repair

NEIGHBOURS = 40
"""Rows on either side that a spline is laid through; further ones change nothing."""
FEWEST = 4
"""Rows of a stretch that can be corrected."""


def repaired_log(log: JointLog, robot: RobotModel, repairs: Iterable[Repair]) -> JointLog:
    """Correct a log's channels by all repairs that are of it, in whatever order they are given.

    Parameters
    ----------
    robot
        The robot of the log: it turns currents into joint torque where currents were logged.

    Returns
    -------
    JointLog
        Its stretches end earlier where a repair needs rows that lie beyond them.

    Raises
    ------
    LogError
        If the log holds currents, and the robot does not say what torque a current gives; if no stretch of it
        is long enough to be corrected.
    """
    corrections = _sort_corrections(repairs)
    if not corrections:
        return log
    reach = sum(int(np.ceil(cause.reach(repair.numbers) * log.rate_hz)) for repair, cause in corrections)
    source = RepairedSource(log, effort_scale(log, robot), corrections, reach)
    inner = tuple((start + reach, stop - reach) for start, stop in log.segments if stop - start > 2 * reach)
    if not inner:
        raise LogError(
            "no stretch of the log between its gaps is long enough to be repaired",
            evidence={"longest_samples": max(stop - start for start, stop in log.segments), "log": log.name},
            remedy=f"record more than {2 * reach} samples without gaps",
        )
    return replace(log, name=f"{log.name}, repaired", source=source, segments=inner, sha256="")


def _sort_corrections(repairs: Iterable[Repair]) -> tuple[tuple[Repair, CorrectsLog], ...]:
    """Give the repairs of a log with their causes, in the order in which they are carried out.

    The catalogue has a channel's scale before its zero and both before their lateness: the last goes first.
    """
    causes: Mapping[str, object] = BY_ID
    rank = {name: -number for number, name in enumerate(BY_ID)}
    chosen = [repair for repair in repairs if repair.mends == "log"]
    chosen.sort(key=lambda repair: rank.get(repair.cause, 0))
    known = [(repair, causes.get(repair.cause)) for repair in chosen]
    return tuple((repair, cause) for repair, cause in known if isinstance(cause, CorrectsLog))


@dataclass(frozen=True, eq=False)
class RepairedSource:
    """Give the rows of a log as they were corrected."""

    log: JointLog
    effort_scale: JointVector
    """Per joint, torque per unit of the logged effort."""
    corrections: tuple[tuple[Repair, CorrectsLog], ...]
    reach: int
    """Rows on either side that the repairs need."""

    @property
    def samples(self) -> int:
        """Count the rows."""
        return self.log.samples

    def rows(self, start: int, stop: int) -> LogRows:
        """Read and correct the rows from start up to, not including, stop."""
        low, high = max(0, start - self.reach - NEIGHBOURS), min(self.samples, stop + self.reach + NEIGHBOURS)
        read = self.log.source.rows(low, high)
        borders = {border - low for segment in self.log.segments for border in segment if low < border < high}
        cuts = sorted({0, high - low} | borders)
        parts = [self._correct(rows_at(read, slice(*cut))) for cut in pairwise(cuts)]
        return rows_at(_concatenate(parts), slice(start - low, stop - low))

    def _correct(self, rows: LogRows) -> LogRows:
        """Correct a stretch without gaps; rows that repeat the row before do so again."""
        fresh = ~dropped_mask(rows)
        if np.count_nonzero(fresh) < FEWEST:
            return rows
        corrected = self._with_torque(rows_at(rows, fresh))
        for repair, cause in self.corrections:
            corrected = cause.corrected_rows(corrected, repair.joints, repair.numbers)
        held = rows_at(self._with_channel(corrected, rows), np.cumsum(fresh) - 1)
        return replace(held, time=rows.time)

    def _with_torque(self, rows: LogRows) -> LogRows:
        if rows.torque is not None or rows.current is None:
            return rows
        return replace(rows, torque=rows.current * self.effort_scale)

    def _with_channel(self, corrected: LogRows, rows: LogRows) -> LogRows:
        """Give the effort back to the channel that it was logged in."""
        if rows.torque is not None or corrected.torque is None:
            return corrected
        return replace(corrected, torque=None, current=corrected.torque / self.effort_scale)


def _concatenate(parts: list[LogRows]) -> LogRows:
    channels = {field.name: [getattr(part, field.name) for part in parts] for field in fields(LogRows)}
    return LogRows(**{name: np.concatenate(own) for name, own in channels.items() if own[0] is not None})
