"""Give the samples of a source piece by piece, or without some rows."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import Indices
from ..model import LogRows, LogSource, joined_rows, rows_at

BLOCK_ROWS = 32_768
"""So many rows are read at a time: a long stretch that is left out takes no memory."""


@dataclass(frozen=True)
class Piece:
    """Name rows of a source that follow each other, and what is added to their stamps, s."""

    start: int
    stop: int
    shift: float = 0.0


class PiecedSource:
    """Give the rows of some pieces of a source as if they were all there is.

    Examples
    --------
    >>> from veritorque.core.log.model import ArraySource
    >>> whole = ArraySource(LogRows(np.arange(9.0), np.arange(9.0)[:, None]))
    >>> PiecedSource(whole, [Piece(1, 4), Piece(6, 9, 10.0)]).rows(2, 5).time
    array([ 3., 16., 17.])
    """

    def __init__(self, source: LogSource, pieces: Sequence[Piece]) -> None:
        self._source = source
        self._pieces = tuple(pieces)
        self._firsts = np.cumsum([0, *(piece.stop - piece.start for piece in pieces)])

    @property
    def samples(self) -> int:
        """Count the rows."""
        return int(self._firsts[-1])

    def row_in_source(self, row: int) -> int:
        """Give the number that a row has in the source."""
        at = int(np.searchsorted(self._firsts, row, side="right")) - 1
        at = min(at, len(self._pieces) - 1)
        return self._pieces[at].start + row - int(self._firsts[at])

    def rows(self, start: int, stop: int) -> LogRows:
        """Read the rows from start up to, not including, stop."""
        start, stop, _ = slice(start, stop).indices(self.samples)
        found = []
        begin = max(int(np.searchsorted(self._firsts, start, side="right")) - 1, 0)
        end = int(np.searchsorted(self._firsts, stop, side="left"))
        for piece, first in zip(self._pieces[begin:end], self._firsts[begin:end], strict=True):
            low = max(start - int(first), 0)
            high = min(stop - int(first), piece.stop - piece.start)
            if low < high:
                found.append(_shifted(self._source.rows(piece.start + low, piece.start + high), piece.shift))
        if not found:
            return self._source.rows(self._pieces[0].start, self._pieces[0].start)
        return found[0] if len(found) == 1 else joined_rows(found)


class WithoutRows:
    """Give the rows of a source without some of them.

    Parameters
    ----------
    source
        All rows.
    left_out
        Numbers of the rows to leave out, ascending.

    Examples
    --------
    >>> from veritorque.core.log.model import ArraySource
    >>> whole = ArraySource(LogRows(np.arange(9.0), np.arange(9.0)[:, None]))
    >>> WithoutRows(whole, np.array([0, 3, 4])).rows(1, 4).time
    array([2., 5., 6.])
    """

    def __init__(self, source: LogSource, left_out: Indices) -> None:
        self._source = source
        self._left_out = left_out
        self._before = left_out - np.arange(len(left_out))
        """How many rows stay before each that is left out."""

    @property
    def samples(self) -> int:
        """Count the rows."""
        return self._source.samples - len(self._left_out)

    def row_in_source(self, row: int) -> int:
        """Give the number that a row has in the source."""
        return row + int(np.searchsorted(self._before, row, side="right"))

    def rows(self, start: int, stop: int) -> LogRows:
        """Read the rows from start up to, not including, stop."""
        start, stop, _ = slice(start, stop).indices(self.samples)
        first = self.row_in_source(start)
        last = self.row_in_source(stop - 1) + 1 if start < stop else first
        if first >= last:
            return self._source.rows(first, first)
        parts = [self._whole(at, min(at + BLOCK_ROWS, last)) for at in range(first, last, BLOCK_ROWS)]
        return parts[0] if len(parts) == 1 else joined_rows(parts)

    def _whole(self, first: int, last: int) -> LogRows:
        rows = self._source.rows(first, last)
        low, high = np.searchsorted(self._left_out, [first, last])
        if low == high:
            return rows
        kept = np.ones(last - first, dtype=bool)
        kept[self._left_out[low:high] - first] = False
        return rows_at(rows, kept)


def _shifted(rows: LogRows, shift: float) -> LogRows:
    return LogRows(rows.time + shift, **rows.channels()) if shift else rows
