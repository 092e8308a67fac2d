"""Look at the bytes of a text table before its rows are parsed: first lines and encoding."""

import codecs
import re
from collections.abc import Sequence
from itertools import islice
from pathlib import Path

from ...errors import LogError
from .text_header import DELIMITERS, is_comment

HEAD_BYTES = 1 << 20
MOST_HEAD_BYTES = 64 << 20
"""Where the header has to have come, whatever stands before it."""
MAX_COMMENTS = 100_000


UTF_8, WESTERN = "utf-8", "cp1252"


def encoding_of(path: Path) -> str:
    """Tell UTF-8 from the code page of recorders on Windows, which write degrees and umlauts in one byte.

    Numbers are the same in both; names and units differ.
    """
    with path.open("rb") as stream:
        head = stream.read(HEAD_BYTES)
    try:
        codecs.getincrementaldecoder(UTF_8)().decode(head)
    except UnicodeDecodeError:
        return WESTERN
    return UTF_8


def opening_lines(path: Path, encoding: str) -> list[str]:
    """Read the first megabyte, and on where it holds nothing but comments and perhaps one line more."""
    with path.open("rb") as stream:
        head = stream.read(HEAD_BYTES)
        lines = _lines(head, encoding)
        while len(_content(lines)) < 2 and len(lines) <= MAX_COMMENTS and len(head) < MOST_HEAD_BYTES:
            more = stream.read(len(head))
            if not more:
                break
            head += more
            lines = _lines(head, encoding)
    return lines


def _lines(head: bytes, encoding: str) -> list[str]:
    return re.split("\r\n|\r|\n", _decode(head, encoding))


def _content(lines: Sequence[str]) -> list[int]:
    """Give the indices of the first two lines that are no comment."""
    indices = (index for index, line in enumerate(lines) if not is_comment(line))
    return list(islice(indices, 2))


def check_text(path: Path, header: str, encoding: str) -> int:
    """Refuse NUL bytes, other encodings, lines of a megabyte and endless comments; count repeated headers."""
    begin = comments = repeated = 0
    again = b"\n" + header.strip().encode(encoding)
    decoder = codecs.getincrementaldecoder(encoding)()
    with path.open("rb") as stream:
        while piece := stream.read(HEAD_BYTES):
            try:
                decoder.decode(piece)
            except UnicodeDecodeError as error:
                raise _not_utf8(begin, error) from error
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
            repeated += piece.count(again) if header else 0
            comments += piece.count(b"\n#")
            if comments > MAX_COMMENTS:
                raise LogError(
                    "the text holds more comments than a log has",
                    evidence={"comment_lines": comments, "at_most": MAX_COMMENTS},
                    remedy="save the rows without them",
                )
    return repeated


def _decode(head: bytes, encoding: str) -> str:
    if b"\n" not in head and b"\r" not in head and len(head) == HEAD_BYTES:
        raise LogError(
            "the first line is longer than 1 MB, which no header of a log is",
            evidence={"delimiters": max(head.count(mark.encode()) for mark in DELIMITERS)},
            remedy="put the column names on the first line and keep the columns of the log only",
        )
    try:
        text = head[: head.rfind(b"\n") + 1 or None]
        return text.decode("utf-8-sig" if encoding == UTF_8 else encoding)
    except UnicodeDecodeError as error:
        raise _not_utf8(0, error) from error


def _not_utf8(begin: int, error: UnicodeDecodeError) -> LogError:
    return LogError(
        "the text is not UTF-8",
        evidence={"byte": begin + error.start, "value": error.object[error.start]},
        remedy="save the file as UTF-8",
    )
