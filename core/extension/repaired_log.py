"""Give a log as it would have been without the faults that were found in its channels.

Rows that stand for dropped samples go on repeating the row before.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import JointVector
from ..diagnosis.causes.registry import BY_ID
from ..diagnosis.causes.repairs import CorrectsLog
from ..errors import LogError
from ..log.corrected import FEWEST, CorrectedSource
from ..log.model import JointLog, LogRows, rows_at
from ..robot.model import RobotModel
from ..signals.condition import effort_scale
from ..signals.resample import dropped_mask
from .repair import Repair


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
    source = CorrectedSource(log, _Correction(effort_scale(log, robot), corrections).rows, reach)
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
class _Correction:
    """Carry out all repairs of a log on a stretch without gaps."""

    effort_scale: JointVector
    """Per joint, torque per unit of the logged effort."""
    corrections: tuple[tuple[Repair, CorrectsLog], ...]

    def rows(self, rows: LogRows) -> LogRows:
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
