"""Give the bytes of a text table with one tab between its cells, and without lines that are no rows."""

import io
import re
from collections.abc import Mapping
from io import BufferedReader

BLOCK_BYTES = 1 << 20
_BLANKS = re.compile(rb"[ \t]+")
_EDGES = re.compile(rb"^\t|\t(?=\r?$)", re.MULTILINE)


class TidyLines(io.RawIOBase):
    """Read a file of UTF-8 line by line, as the parser of tables wants its lines.

    Parameters
    ----------
    blanks
        Whether any number of blanks and tabs separates two cells.
    without
        A line that is left out where it comes again; empty for none.
    instead
        What is given in the place of a line, by its number from 1.
    skip
        Physical lines before the first row of data, which are given as they are.
    """

    def __init__(
        self, file: BufferedReader, *, blanks: bool, without: bytes, instead: Mapping[int, bytes], skip: int
    ) -> None:
        super().__init__()
        self._file = file
        self._blanks = blanks
        self._without = without
        self._instead = instead
        self._skip = skip
        self._line = 0
        self._rest = b""
        self._ready = b""

    def readable(self) -> bool:
        """Tell that bytes can be read."""
        return True

    def read(self, size: int = -1) -> bytes:
        """Give up to so many bytes; all that is left where none is said."""
        while size < 0 or len(self._ready) < size:
            block = self._file.read(BLOCK_BYTES)
            if not block:
                self._ready += self._tidy(self._rest)
                self._rest = b""
                break
            lines, mark, self._rest = (self._rest + block).rpartition(b"\n")
            self._ready += self._tidy(lines + mark)
        size = len(self._ready) if size < 0 else size
        given, self._ready = self._ready[:size], self._ready[size:]
        return given

    def close(self) -> None:
        """Close the file."""
        self._file.close()
        super().close()

    def _tidy(self, lines: bytes) -> bytes:
        if self._without or self._instead:
            return b"".join(map(self._row, lines.splitlines(keepends=True)))
        return self._separated(lines)

    def _row(self, line: bytes) -> bytes:
        self._line += 1
        if self._line in self._instead:
            return self._instead[self._line]
        if self._line > self._skip and self._without and line.strip() == self._without:
            return b""
        return self._separated(line)

    def _separated(self, lines: bytes) -> bytes:
        return _EDGES.sub(b"", _BLANKS.sub(b"\t", lines)) if self._blanks else lines
