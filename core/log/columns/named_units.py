"""Read a unit off a column's name or off a row of units below the header, however it is spelt."""

import re
from typing import Final

from ..channels import TIME, UNITS

_SPELLINGS: Final = {
    "s": ("s", "sec", "secs", "second", "seconds"),
    "ms": ("ms", "msec", "millis", "milliseconds"),
    "us": ("us", "µs", "μs", "usec", "micros", "microseconds"),
    "ns": ("ns", "nsec", "nanos", "nanoseconds", "nanosec"),
    "rad": ("rad", "rads", "radian", "radians"),
    "deg": ("deg", "degs", "°", "degree", "degrees"),
    "counts": ("counts", "count", "cnt", "cnts", "inc", "incr", "increments", "ticks"),
    "mm": ("mm",),
    "m": ("m",),
    "rad/s": ("rad/s", "rads/s", "radps", "rad_s", "rad/sec"),
    "deg/s": ("deg/s", "°/s", "dps", "degps", "deg_s", "deg/sec", "degrees/s"),
    "rpm": ("rpm", "1/min", "rev/min", "r/min"),
    "m/s": ("m/s",),
    "mm/s": ("mm/s",),
    "N m": ("nm", "n m", "n*m", "n.m", "n·m", "n-m", "newtonmeter"),
    "mN m": ("mnm", "mn m", "mn*m", "mn.m", "mn·m"),
    "N": ("n",),
    "A": ("a", "amp", "amps", "ampere", "amperes"),
    "mA": ("ma", "milliamp", "milliamps"),
    "degC": ("degc", "°c", "c", "celsius"),
    "K": ("k", "kelvin"),
    "V": ("v", "volt", "volts"),
    "%": ("%", "percent", "pct", "per cent"),
    "1": ("1", "-"),
}
"""How recorders spell each unit, in small letters."""
_NAMES: Final = {spelling: unit for unit, spellings in _SPELLINGS.items() for spelling in spellings}
UNIT_WORDS: Final = frozenset((*_NAMES, "w", "hz", "rad/s2", "rad/s^2", "mv", "kn", "g"))
"""Words of which a row of units is made, those of other quantities among them."""
_BRACKETS = re.compile(r"[\[({<]([^\[\](){}<>]*)[\])}>]\s*$")
_SUFFIX = re.compile(r"[_ .,/-]([A-Za-z%°µμ]+)(?:[_ ]?\d+)?$")


def unit_called(channel: str, word: str) -> str | None:
    """Give the unit of a channel that a word means; None where it means none.

    Examples
    --------
    >>> unit_called("torque", "Nm"), unit_called("position", "°"), unit_called("position", "Nm")
    ('N m', 'deg', None)
    """
    unit = _NAMES.get(word.strip().strip("[](){}").strip().lower())
    return unit if unit in UNITS[channel] else None


def unit_in_name(channel: str, name: str) -> str | None:
    """Read the unit off a column's name: in brackets at its end, or its last word.

    Examples
    --------
    >>> (
    ...     unit_in_name("torque", "torque1(%)"),
    ...     unit_in_name("time", "stamp_ns"),
    ...     unit_in_name("position", "pos_m"),
    ... )
    ('%', 'ns', None)
    """
    if bracket := _BRACKETS.search(name):
        return unit_called(channel, bracket[1])
    suffix = _SUFFIX.search(name)
    if suffix is None:
        return None
    unit = unit_called(channel, suffix[1])
    letter = len(suffix[1]) == 1 and suffix[1] != "%"
    return None if letter and (channel, unit) not in ((TIME, "s"), ("current", "A")) else unit
