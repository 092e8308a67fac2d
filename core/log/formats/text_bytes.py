"""Look at the bytes of a text table before its rows are parsed: first lines and encoding.

Text in another encoding is turned into UTF-8 as it is read, so that whatever comes after knows no other.
"""

import codecs
import io
import re
from collections.abc import Sequence
from itertools import islice
from pathlib import Path

from ...errors import LogError
from .text_cells import DELIMITERS, is_comment

HEAD_BYTES = 1 << 20
MOST_HEAD_BYTES = 64 << 20
"""Where the header has to have come, whatever stands before it."""
MAX_COMMENTS = 100_000


UTF_8, UTF_16, WESTERN = "utf-8", "utf-16", "cp1252"
BYTE_ORDER_MARKS = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)


def encoding_of(path: Path) -> str:
    """Tell UTF-8 from what is usual on Windows: UTF-16 with its mark, and degrees and umlauts in one byte.

    Numbers are the same in the code page and in UTF-8; names and units differ.
    """
    with path.open("rb") as stream:
        head = stream.read(HEAD_BYTES)
    if head.startswith(BYTE_ORDER_MARKS):
        return UTF_16
    try:
        codecs.getincrementaldecoder(UTF_8)().decode(head)
    except UnicodeDecodeError:
        return WESTERN
    return UTF_8


def open_utf8(path: Path, encoding: str) -> io.BufferedReader:
    """Open text to read it as UTF-8, in whatever encoding it is."""
    if encoding == UTF_8:
        return path.open("rb")
    return io.BufferedReader(_Recoded(path, encoding))


class _Recoded(io.RawIOBase):
    """Give text of another encoding as UTF-8; half a character at the very end is left out."""

    def __init__(self, path: Path, encoding: str) -> None:
        super().__init__()
        self._file = path.open("rb")
        self._encoding = encoding
        self._decoder = codecs.getincrementaldecoder(encoding)()
        self._ready = memoryview(b"")

    def readable(self) -> bool:
        """Tell that bytes can be read."""
        return True

    def readinto(self, buffer: memoryview) -> int:  # type: ignore[override]  # every buffer can be one
        """Fill a buffer, or part of it; 0 at the end.

        Raises
        ------
        LogError
            If the bytes are not of this encoding.
        """
        while not self._ready:
            begin = self._file.tell()
            block = self._file.read(HEAD_BYTES)
            if not block:
                return 0
            try:
                self._ready = memoryview(self._decoder.decode(block).encode())
            except UnicodeError as error:
                raise _not_encoded(self._encoding, begin, error) from error
        size = min(len(buffer), len(self._ready))
        buffer[:size] = self._ready[:size]
        self._ready = self._ready[size:]
        return size

    def close(self) -> None:
        """Close the file."""
        self._file.close()
        super().close()


def opening_lines(path: Path, encoding: str) -> list[str]:
    """Read the first megabyte, and on where it holds nothing but comments and perhaps one line more."""
    with open_utf8(path, encoding) as stream:
        head = stream.read(HEAD_BYTES)
        lines = _lines(head)
        while len(_content(lines)) < 2 and len(lines) <= MAX_COMMENTS and len(head) < MOST_HEAD_BYTES:
            more = stream.read(len(head))
            if not more:
                break
            head += more
            lines = _lines(head)
    return lines


def _lines(head: bytes) -> list[str]:
    return re.split("\r\n|\r|\n", _decode(head))


def _content(lines: Sequence[str]) -> list[int]:
    """Give the indices of the first two lines that are no comment."""
    indices = (index for index, line in enumerate(lines) if not is_comment(line))
    return list(islice(indices, 2))


def check_text(path: Path, header: bytes, encoding: str) -> int:
    """Refuse NUL bytes, other encodings, lines of a megabyte and endless comments; count repeated headers."""
    begin = comments = repeated = 0
    again = b"\n" + header
    decoder = codecs.getincrementaldecoder(UTF_8)()
    with open_utf8(path, encoding) as stream:
        while piece := stream.read(HEAD_BYTES):
            try:
                decoder.decode(piece)
            except UnicodeDecodeError as error:
                raise _not_encoded(UTF_8, begin, error) from error
            if b"\x00" in piece:
                raise LogError(
                    "the text holds NUL bytes",
                    evidence={"first_at_byte": begin + piece.index(b"\x00")},
                    remedy="save the table again as plain UTF-8 text",
                )
            begin += len(piece)
            if len(piece) == HEAD_BYTES and b"\n" not in piece and b"\r" not in piece:
                raise LogError(
                    "a line is longer than 1 MB, which no row of a log is",
                    evidence={"before_byte": begin},
                    remedy="write one row per line",
                )
            repeated += _count(piece, again)
            comments += _count(piece, b"\n#") + _count(piece, b"\n%")
            if comments > MAX_COMMENTS:
                raise LogError(
                    "the text holds more comments than a log has",
                    evidence={"comment_lines": comments, "at_most": MAX_COMMENTS},
                    remedy="save the rows without them",
                )
    return repeated


def _count(piece: bytes, line: bytes) -> int:
    """Count the beginnings of a line after a line end, if any: its first byte alone is found fast."""
    return piece.count(line) if line[1:] and line[1:2] in piece else 0


def _decode(head: bytes) -> str:
    if b"\n" not in head and b"\r" not in head and len(head) == HEAD_BYTES:
        raise LogError(
            "the first line is longer than 1 MB, which no header of a log is",
            evidence={"delimiters": max(head.count(mark.encode()) for mark in DELIMITERS)},
            remedy="put the column names on the first line and keep the columns of the log only",
        )
    try:
        text = head[: head.rfind(b"\n") + 1 or None]
        return text.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise _not_encoded(UTF_8, 0, error) from error


def _not_encoded(encoding: str, begin: int, error: UnicodeError) -> LogError:
    """Report bytes that are no text; where the code page fails, UTF-8 did before."""
    at = {"byte": begin + error.start} if isinstance(error, UnicodeDecodeError) else {}
    return LogError(
        f"the text is not {'UTF-16, which its mark announces' if encoding == UTF_16 else 'UTF-8'}",
        evidence=at | {"detail": str(error)[:200]},
        remedy="save the file as UTF-8",
    )
