"""Find rows inside a log that say nothing: written twice, stamp and all, or zeros of a lost packet.

A recorder writes a row again where it flushes twice, and zeros where a packet is lost. Neither is a defect of
the clock or of the motion, so that both are left out before these are judged.
"""

import numpy as np

from ...arrays import Indices, JointSeries, JointVector, SampleMask
from ..defects.stretch import count_text
from ..model import STANDING_ROWS, Defect, LogRows, rows_at
from .ends import JUMP_FACTOR, USUAL_SHARE

_STATEMENTS = {
    "doubled_rows": "repeat the row before, stamp and all, and are left out",
    "blank_rows": "are zero in all positions and efforts between rows that are not, and are left out",
}


class IdleRows:
    """Collect the rows that say nothing, stretch after stretch of a file."""

    def __init__(self) -> None:
        self._found: dict[str, list[Indices]] = {kind: [] for kind in _STATEMENTS}
        self._last: LogRows | None = None

    def take(self, rows: LogRows, first: int) -> None:
        """Take the next rows, the first of which has this number."""
        for kind, marks in (("doubled_rows", _doubled(rows, self._last)), ("blank_rows", _blank(rows))):
            if marks.any():
                self._found[kind].append(first + np.flatnonzero(marks))
        self._last = rows_at(rows, slice(-1, None))

    def numbers(self) -> Indices:
        """Give the numbers of all of them."""
        parts = [part for parts in self._found.values() for part in parts]
        return np.unique(np.concatenate(parts)) if parts else np.zeros(0, dtype=int)

    def defects(self) -> tuple[Defect, ...]:
        """Say what they are."""
        counts = {kind: sum(map(len, parts)) for kind, parts in self._found.items()}
        return tuple(
            Defect(kind, "file", None, count, (), f"{count_text(count, 'row')} {_STATEMENTS[kind]}.")
            for kind, count in counts.items()
            if count
        )


def _doubled(rows: LogRows, last: LogRows | None) -> SampleMask:
    marks = np.zeros(len(rows.time), dtype=bool)
    marks[1:] = rows.time[1:] == rows.time[:-1]
    if last is not None and len(marks) and rows.time[0] == last.time[-1]:
        before, first = last.channels(), rows_at(rows, slice(0, 1)).channels()
        marks[0] = all(np.array_equal(values, before[name], equal_nan=True) for name, values in first.items())
    for values in rows.channels().values() if marks[1:].any() else ():
        marks[1:] &= np.all((values[1:] == values[:-1]) | np.isnan(values[1:]), axis=1)
    return marks


def _all_zero(rows: LogRows) -> SampleMask:
    """Mark the rows whose positions and efforts are all zero."""
    channels = (rows.position, rows.torque, rows.current)
    zero = [np.all(values == 0.0, axis=1) for values in channels if values is not None]
    return np.asarray(np.logical_and.reduce(zero))


def _usual_step(channel: JointSeries) -> JointVector:
    """Give, per joint, a step that most steps do not exceed."""
    steps = np.abs(np.diff(channel, axis=0))
    known = steps[np.isfinite(steps).all(axis=1)]
    return np.quantile(known, USUAL_SHARE, axis=0) if len(known) else np.full(steps.shape[1], np.inf)


def _blank(rows: LogRows) -> SampleMask:
    """Mark short runs of zeros between rows of which a position or an effort is too far from zero."""
    zero = _all_zero(rows)
    marks = np.zeros(len(zero), dtype=bool)
    if not 0 < np.count_nonzero(zero) < len(zero):
        return marks
    channels = [values for values in (rows.position, rows.torque, rows.current) if values is not None]
    far = [JUMP_FACTOR * _usual_step(values[~zero]) for values in channels]
    edges = np.flatnonzero(np.diff(zero, prepend=False, append=False))
    for start, stop in zip(edges[::2], edges[1::2], strict=True):
        if _is_inside(rows, int(start), int(stop)):
            pairs = zip(channels, far, strict=True)
            marks[start:stop] = any(_are_far(values[[start - 1, stop]], most) for values, most in pairs)
    return marks


def _is_inside(rows: LogRows, start: int, stop: int) -> bool:
    """Tell whether rows are few, and neither at an end of the log nor of a run."""
    inside = 0 < start < stop < len(rows.time) and stop - start <= STANDING_ROWS
    return inside and bool(np.all(np.diff(rows.time[start - 1 : stop + 1]) >= 0.0))


def _are_far(beside: JointSeries, far: JointVector) -> bool:
    """Tell whether both rows beside a run of zeros are far from it."""
    return bool(np.any(np.min(np.abs(beside), axis=0) > far))
