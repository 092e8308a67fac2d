"""Turn dates and times of day into seconds: ISO 8601, with or without a date, a fraction and a zone.

A date in another order is left out, since the time of day goes on after midnight; a count of days is kept.
"""

import re

import numpy as np
import pyarrow as pa

from ...arrays import Samples
from ...errors import LogError

DAY_S = 86_400.0
NANOSECONDS = 1e9
_OTHER_DATE = re.compile(r"(?!\d{4}-)\d{1,4}([./-])\d{1,2}\1\d{1,4}[ ,T]+")
_DAYS = re.compile(r"(\d+) days? ")
_TIME = re.compile(r"(\d{1,2})(:\d{2}:\d{2})(?:[.,]|:(?=\d{3}$))?(.*)")


class Clock:
    """Count seconds from the first stamp of a column on; a time of day goes on after midnight.

    Examples
    --------
    >>> Clock().seconds(pa.array(["23:59:59.5", "00:00:00.25"]))
    array([0.  , 0.75])
    """

    def __init__(self) -> None:
        self._first: int | None = None
        self._last = 0.0
        self._days = 0

    def seconds(self, column: pa.Array) -> Samples:
        """Read the next stamps; what is empty is NaN.

        Raises
        ------
        LogError
            If a cell is no stamp.
        """
        stamps = _nanoseconds(column)
        known = np.flatnonzero(stamps != _NONE)
        if len(known) == 0:
            return np.full(len(stamps), np.nan)
        if self._first is None:
            self._first = int(stamps[known[0]])
        seconds = np.where(stamps == _NONE, np.nan, (stamps - self._first) / NANOSECONDS)
        if 0 <= self._first < DAY_S * NANOSECONDS:
            seconds[known] += self._days * DAY_S
            midnights = np.diff(seconds[known], prepend=self._last) < -0.5 * DAY_S
            seconds[known] += DAY_S * np.cumsum(midnights)
            self._days += int(np.count_nonzero(midnights))
        self._last = float(seconds[known[-1]])
        return seconds


_NONE = np.iinfo(np.int64).min


def _dated(word: str | None) -> str | None:
    """Write a stamp as ISO 8601 does; a time of day is one of the first day."""
    if not word:
        return None
    text = word.strip()
    other = _OTHER_DATE.match(text)
    text = text[other.end() :] if other else text
    days = _DAYS.match(text)
    date, time = _parted(text[days.end() :] if days else text)
    found = _TIME.fullmatch(time)
    if found is None:
        return text
    hour, rest, fraction = found.groups()
    if days:
        date = str(np.datetime64("1970-01-01") + int(days[1]))
    dot = "." if fraction[:1].isdigit() else ""
    return f"{date}T{hour:0>2}{rest}{dot}{fraction}"


def _parted(text: str) -> tuple[str, str]:
    """Part a date from the time of day; a time of day alone is one of the first day."""
    date, mark, time = text.replace("T", " ").partition(" ")
    return (date, time.strip()) if mark else ("1970-01-01", date)


def _nanoseconds(column: pa.Array) -> np.ndarray:
    dated = list(map(_dated, column.to_pylist()))
    zoned = next(filter(None, dated), "")
    zone = "UTC" if zoned.endswith("Z") or any(mark in zoned[11:] for mark in "+-") else None
    try:
        stamps = pa.array(dated, pa.string()).cast(pa.timestamp("ns", zone)).cast(pa.int64())
    except pa.ArrowInvalid as error:
        raise LogError(
            "a column of dates or times of day holds something else",
            evidence={"detail": str(error)[:200]},
            remedy="write every stamp as the first one is, to nanoseconds at most, or map another column",
        ) from error
    return np.asarray(np.from_dlpack(stamps.fill_null(_NONE)))
