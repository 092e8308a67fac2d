"""Give the samples of a source piece by piece: what lies between the pieces is left out."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..model import LogRows, LogSource


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
        return found[0] if len(found) == 1 else _joined(found)


def _shifted(rows: LogRows, shift: float) -> LogRows:
    return LogRows(rows.time + shift, **rows.channels()) if shift else rows


def _joined(parts: Sequence[LogRows]) -> LogRows:
    channels = [part.channels() for part in parts]
    return LogRows(
        np.concatenate([part.time for part in parts]),
        **{name: np.concatenate([channel[name] for channel in channels]) for name in channels[0]},
    )
