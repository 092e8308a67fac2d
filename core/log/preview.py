"""Thin long traces for display: of every stretch of rows the smallest and the largest value are kept.

A screen is some thousand points wide and a log is millions of rows long. Every n-th row would lose spikes and
alias vibration into slow waves; the extremes of each stretch draw the same picture as all rows would.
All traces share one time axis, so that plots of them can share a cursor.
"""

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import ceil

import numpy as np

from ..arrays import Instants, InstantSeries, JointSeries, Samples
from ..errors import OptionError
from .model import JointLog

MOST_POINTS = 4000
FEWEST_POINTS = 10
CHUNK_ROWS = 1 << 16
"""Rows read at a time, beside those of one stretch."""
SHARE_OF_GAPS = 8
"""At most one point in this many marks a gap."""
Rows = Callable[[int, int], tuple[Samples, JointSeries]]
Stretches = Sequence[tuple[int, int]]


@dataclass(frozen=True, eq=False)
class Preview:
    """Carry thinned traces."""

    time: Instants
    """Stamps in s, ascending. Of a stretch's two extremes the earlier is drawn at its first stamp, the later
    at its last; an extreme is thus at most one stretch away from where it was."""
    values: InstantSeries
    """One column per trace; NaN in all of them at a gap."""
    rows_per_stretch: int
    """How many rows became two points; 1 where every row is kept as it is."""


def preview(
    log: JointLog,
    channels: Sequence[str],
    *,
    points: int = MOST_POINTS,
    begin: float | None = None,
    end: float | None = None,
) -> Preview:
    """Thin channels of a log, read piece by piece; one column per channel and joint, channel by channel.

    Parameters
    ----------
    channels
        Names of channels that the log has.
    points
        The most points per trace, `FEWEST_POINTS` at least.
    begin, end
        Stretch of the log's clock, s; None for its own ends.

    Raises
    ------
    OptionError
        If nothing was measured in that stretch of time.
    """
    first, last = rows_between(
        lambda row: float(log.source.rows(row, row + 1).time[0]), log.samples, begin, end
    )
    inside = [(max(start, first), min(stop, last)) for start, stop in log.segments]

    def read(start: int, stop: int) -> tuple[Samples, JointSeries]:
        rows = log.source.rows(start, stop)
        return rows.time, np.hstack([getattr(rows, channel) for channel in channels])

    return thin(read, [(start, stop) for start, stop in inside if start < stop], points=points)


def rows_between(
    stamp: Callable[[int], float], samples: int, begin: float | None, end: float | None
) -> tuple[int, int]:
    """Give the (start, stop) rows of a stretch of time, and one more on either side.

    So that lines leave the picture.

    Parameters
    ----------
    stamp
        Gives the instant of a row, s; ascending.
    begin, end
        None for the first and the last instant.

    Raises
    ------
    OptionError
        If nothing was measured in that stretch of time.

    Examples
    --------
    >>> rows_between(float, 100, 9.5, 20.0)
    (9, 22)
    """
    ends = stamp(0), stamp(samples - 1)
    low, high = ends[0] if begin is None else begin, ends[1] if end is None else end
    first = bisect_left(range(samples), low, key=stamp)
    last = bisect_right(range(samples), high, key=stamp)
    if not low < high or last <= 0 or first >= samples:
        raise OptionError(
            "nothing was measured in that stretch of time",
            evidence={"from": low, "to": high, "first_s": round(ends[0], 6), "last_s": round(ends[1], 6)},
            remedy="ask for a stretch between the first and the last instant, from before to",
        )
    return max(first - 1, 0), min(last + 1, samples)


def thin(read: Rows, segments: Stretches, *, points: int) -> Preview:
    """Thin traces that are read by rows.

    Parameters
    ----------
    read
        Gives stamps (s) of the rows from start up to stop, and values, one column per trace; what is NaN is
        passed over, and drawn as a gap where a stretch holds nothing else.
    segments
        (start, stop) rows of the stretches between gaps, in order. Where there are more than an eighth of the
        points, neighbours are joined.
    points
        The most points per trace, `FEWEST_POINTS` at least.

    Examples
    --------
    >>> time, spike = np.arange(1000.0), np.zeros((1000, 1))
    >>> spike[437] = 5.0
    >>> seen = thin(lambda start, stop: (time[start:stop], spike[start:stop]), ((0, 1000),), points=20)
    >>> len(seen.time), float(seen.values.max())
    (20, 5.0)
    """
    kept = _join(segments, max(1, points // SHARE_OF_GAPS))
    size = _rows_per_stretch([stop - start for start, stop in kept], points)
    pieces: list[tuple[Instants, InstantSeries]] = []
    for start, stop in kept:
        piece = list(_thin_segment(read, start, stop, size))
        if pieces:
            middle = 0.5 * (pieces[-1][0][-1] + piece[0][0][0])
            pieces.append((np.array([middle]), np.full((1, piece[0][1].shape[1]), np.nan)))
        pieces += piece
    times, values = zip(*pieces, strict=True)
    return Preview(np.concatenate(times), np.concatenate(values), size)


def _join(segments: Stretches, most: int) -> Stretches:
    """Join neighbours evenly until no more than so many are left."""
    if len(segments) <= most:
        return segments
    borders = np.linspace(0, len(segments), most + 1).astype(int)
    return [(segments[first][0], segments[last - 1][1]) for first, last in pairwise(borders)]


def _rows_per_stretch(lengths: Sequence[int], points: int) -> int:
    """Give the smallest number of rows per pair of points that does with so many points, gaps included."""
    left = points - (len(lengths) - 1)
    if sum(lengths) <= left:
        return 1
    size = max(2, 2 * sum(lengths) // left)
    while sum(2 * ceil(length / size) for length in lengths) > left:
        size += 1
    return size


def _thin_segment(read: Rows, start: int, stop: int, size: int) -> Iterator[tuple[Instants, InstantSeries]]:
    if size == 1:
        yield read(start, stop)
        return
    edges = np.linspace(start, stop, ceil((stop - start) / size) + 1).astype(int)
    at_a_time = max(1, CHUNK_ROWS // size)
    for first in range(0, len(edges) - 1, at_a_time):
        some = edges[first : first + at_a_time + 1]
        time, values = read(int(some[0]), int(some[-1]))
        pairs = [_extremes(time[a:b], values[a:b]) for a, b in pairwise(some - some[0])]
        yield np.concatenate([stamps for stamps, _ in pairs]), np.concatenate([both for _, both in pairs])


def _extremes(time: Samples, values: JointSeries) -> tuple[Instants, InstantSeries]:
    """Give the extremes of one stretch, in the order in which they occurred; a single row as it is."""
    if len(time) == 1:
        return time, values
    absent = np.isnan(values)
    upwards, downwards = np.where(absent, np.inf, values), np.where(absent, -np.inf, values)
    low, high = upwards.min(axis=0), downwards.max(axis=0)
    rising = upwards.argmin(axis=0) <= downwards.argmax(axis=0)
    both = np.stack([np.where(rising, low, high), np.where(rising, high, low)])
    both[:, absent.all(axis=0)] = np.nan
    return time[[0, -1]], both
