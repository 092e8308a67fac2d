"""Find rows inside a log that say nothing: written twice, stamp and all, or a lost packet's zeros.

A recorder writes a row again where it flushes twice, and zeros where a packet is lost; counted from another
zero, these are one row that comes again and again. One channel may be lost alone. None of this is a defect of
the clock or of the motion, so that it is left out before these are judged.
"""

import numpy as np

from ...arrays import Indices, JointMask, JointSeries, JointVector, Mask, SampleMask, Samples
from ..defects.stretch import GRID_STEPS, JUMP_FACTOR, USUAL_SHARE, count_text
from ..model import STANDING_ROWS, Defect, LogRows, rows_at

_STATEMENTS = {
    "doubled_rows": "repeat the row before, stamp and all, and are left out",
    "blank_rows": "hold one value per column, mostly 0, far from the rows on either side, and are left out",
    "lost_values": "hold one value in a position, torque or current, mostly 0, far from those on either "
    "side, and are left out",
}
FEWEST_LOST = 3
"""A channel that is lost for fewer samples has a spike: the median of five takes its place."""
FEWEST_ZEROS = 3
"""Runs of zeros that a channel leaps into and out of, and half of its zeros at least: then none is its own.
One in a hundred of a channel's own zeros leaps like this, so that chance gives 3e-4."""


class IdleRows:
    """Collect the rows that say nothing, stretch after stretch of a file."""

    def __init__(self) -> None:
        self._found: dict[str, list[Indices]] = {kind: [] for kind in _STATEMENTS}
        self._last: LogRows | None = None

    def take(self, rows: LogRows, first: int) -> None:
        """Take the next rows, the first of which has this number."""
        doubled, blank = _doubled(rows, self._last), _blank(rows)
        lost = _lost(rows) & ~blank
        for kind, marks in (("doubled_rows", doubled), ("blank_rows", blank), ("lost_values", lost)):
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


def _blank(rows: LogRows) -> SampleMask:
    """Mark short runs of one row, or of zeros, that a channel leaps into and out of.

    A row that is held because the recorder missed some continues the row before it, and is none of them.
    """
    channels = _measured(rows)
    held = np.zeros(len(rows.time), dtype=bool)
    held[1:] = _everywhere([values[1:] == values[:-1] for values in channels])
    zero = _everywhere([values == 0.0 for values in channels])
    starts, stops = _short_runs(rows.time, held, zero)
    leapt = np.zeros(len(starts), dtype=bool)
    for values in channels if len(starts) else ():
        into, out = (np.abs(values[starts] - values[beside]) for beside in (starts - 1, stops))
        far = JUMP_FACTOR * _usual_step(values[~held & ~zero])
        leapt |= np.any(np.minimum(into, out) > far, axis=1)
    return _between(starts[leapt], stops[leapt], len(held))


def _lost(rows: LogRows) -> SampleMask:
    """Mark short runs of one value, or of zeros, that a channel of one joint leaps into and out of."""
    marks = np.zeros(len(rows.time), dtype=bool)
    for values in _measured(rows):
        same = values[1:] == values[:-1]
        repeated = np.any(same[1:] & same[:-1], axis=0)
        zero = np.count_nonzero(values == 0.0, axis=0) >= FEWEST_ZEROS
        for joint in np.flatnonzero(repeated | zero):
            starts, stops = _lost_runs(values[:, joint])
            inside = _are_inside(rows.time, starts, stops)
            marks |= _between(starts[inside], stops[inside], len(marks))
    return marks


def _lost_runs(values: Samples) -> tuple[Indices, Indices]:
    """Give the first samples of such runs, and the samples behind them.

    The other steps show how large a step usually is. Where every step leads into such a run or out of it, as
    of a channel that is filled with zeros between its samples, those between the other values do.
    """
    edges = np.flatnonzero(values[1:] != values[:-1]) + 1
    steps = np.abs(values[edges] - values[edges - 1])
    lengths = np.diff(edges)
    short = (lengths >= FEWEST_LOST) & (lengths <= STANDING_ROWS)
    zeros = (values[edges[:-1]] == 0.0) & (lengths <= STANDING_ROWS)
    candidates = short | zeros
    beside = np.append(candidates, values[-1] == 0.0) | np.append(values[0] == 0.0, candidates)
    others = steps[~beside & np.isfinite(steps)]
    if not len(others):
        between = np.abs(np.diff(values[edges[:-1][~candidates]]))
        others = between[np.isfinite(between) & (between > 0.0)]
    if not len(others):
        return edges[:0], edges[:0]
    leaps, usual = np.minimum(steps[:-1], steps[1:]), np.quantile(others, USUAL_SHARE)
    lost = short & (leaps > max(JUMP_FACTOR * usual, GRID_STEPS * others.min()))
    # A channel that passes zero has another sign behind it.
    same_sign = np.sign(values[edges[:-1] - 1]) * np.sign(values[edges[1:]]) > 0.0
    returns = zeros & same_sign & (leaps > usual)
    if returns.sum() >= max(FEWEST_ZEROS, 0.5 * zeros.sum()):
        lost |= zeros
    return edges[:-1][lost], edges[1:][lost]


def _measured(rows: LogRows) -> list[JointSeries]:
    return [values for values in (rows.position, rows.torque, rows.current) if values is not None]


def _between(starts: Indices, stops: Indices, samples: int) -> SampleMask:
    """Mark the samples of runs."""
    edges = np.zeros(samples + 1, dtype=int)
    np.add.at(edges, starts, 1)
    np.add.at(edges, stops, -1)
    return np.asarray(np.cumsum(edges[:-1]) > 0)


def _short_runs(time: Samples, held: SampleMask, zero: SampleMask) -> tuple[Indices, Indices]:
    """Give first rows of the runs of one row, or of zeros, inside the log, and the rows behind them."""
    starts = np.flatnonzero(~held & (zero | np.append(held[1:], False)))
    edges = np.append(np.flatnonzero(~held), len(held))
    stops = edges[np.searchsorted(edges, starts) + 1]
    inside = _are_inside(time, starts, stops)
    return starts[inside], stops[inside]


def _everywhere(channels: list[JointMask]) -> SampleMask:
    """Mark the rows in which something holds for all joints of all channels."""
    return np.asarray(np.logical_and.reduce([np.all(values, axis=1) for values in channels]))


def _usual_step(channel: JointSeries) -> JointVector:
    """Give, per joint, a step that most steps do not exceed."""
    steps = np.abs(np.diff(channel, axis=0))
    known = steps[np.isfinite(steps).all(axis=1)]
    return np.quantile(known, USUAL_SHARE, axis=0) if len(known) else np.full(steps.shape[1], np.inf)


def _are_inside(time: Samples, starts: Indices, stops: Indices) -> Mask:
    """Tell which runs are short, and neither at an end of the log nor of a part that its stamps end."""
    backwards = np.append(0, np.cumsum(np.diff(time) < 0.0))
    inner = (starts > 0) & (stops < len(time)) & (stops - starts <= STANDING_ROWS)
    before, behind = np.maximum(starts - 1, 0), np.minimum(stops, len(time) - 1)
    return np.asarray(inner & (backwards[before] == backwards[behind]))
