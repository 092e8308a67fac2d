"""Tell two result documents apart: what a program would notice, and what only a reader would.

Both documents are walked together. A key that one of them lacks, another length, another number in its last
digit, another name: each is a difference. Texts differ from names by a rule that a reader can check:
a string is text if its key is in PROSE and it has a space in both documents. All other strings count like
numbers. The order of keys is no part of an answer.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

PROSE = frozenset(
    (
        "doubts",
        "message",
        "note",
        "notes",
        "reason",
        "remedy",
        "separating_experiment",
        "statement",
        "title",
        "what",
        "why",
    )
)
"""Keys whose strings are sentences for a reader; the entries of a list go by the list's key."""
UNTOLD = frozenset({"provenance.version"})
"""Paths that are no part of an answer: the version of the package. No document holds a time of day."""


@dataclass(frozen=True)
class Difference:
    """Say where two documents differ, and how.

    Attributes
    ----------
    path
        Keys down to the place, list places as [3].
    group
        The same with all places of lists as [].
    what
        ``missing``, ``extra``, ``length``, ``value``, or ``text``, which is no failure.
    relative, ulps
        For two numbers, the difference over the larger one and in units of its last place.
    """

    path: str
    group: str
    what: str
    before: object = None
    now: object = None
    relative: float = 0.0
    ulps: float = 0.0

    @property
    def fails(self) -> bool:
        """Tell whether a program would notice."""
        return self.what != "text"


@dataclass(frozen=True)
class Compared:
    """Hold the differences, and how many numbers and strings were looked at."""

    differences: tuple[Difference, ...]
    numbers: int
    strings: int

    @property
    def failures(self) -> tuple[Difference, ...]:
        """Give the differences that a program would notice."""
        return tuple(one for one in self.differences if one.fails)

    @property
    def texts(self) -> tuple[Difference, ...]:
        """Give the differences in wording."""
        return tuple(one for one in self.differences if not one.fails)


@dataclass(frozen=True)
class _Place:
    """Name a place in a document."""

    path: str = ""
    group: str = ""
    key: str = ""

    def at(self, key: str) -> "_Place":
        return _Place(f"{self.path}.{key}".lstrip("."), f"{self.group}.{key}".lstrip("."), key)

    def entry(self, number: int) -> "_Place":
        return _Place(f"{self.path}[{number}]", f"{self.group}[]", self.key)

    def differs(self, what: str, before: object, now: object, **sizes: float) -> Difference:
        return Difference(self.path, self.group, what, before, now, **sizes)


def compare(before: object, now: object) -> Compared:
    """Walk two documents both ways.

    Examples
    --------
    >>> [(one.path, one.what) for one in compare({"a": [1.0, 2.0]}, {"a": [1.0, 2.5], "b": 1}).differences]
    [('b', 'extra'), ('a[1]', 'value')]
    """
    leaves = list(_leaves(before))
    strings = sum(isinstance(one, str) for one in leaves)
    return Compared(tuple(_walk(before, now, _Place())), len(leaves) - strings, strings)


def _leaves(value: object) -> Iterator[object]:
    if isinstance(value, Mapping | list):
        for one in value.values() if isinstance(value, Mapping) else value:
            yield from _leaves(one)
    else:
        yield value


def _walk(before: object, now: object, place: _Place) -> Iterator[Difference]:
    if place.group in UNTOLD:
        return
    if isinstance(before, Mapping) and isinstance(now, Mapping):
        yield from _keys(before, now, place)
    elif isinstance(before, list) and isinstance(now, list):
        if len(before) != len(now):
            yield place.differs("length", len(before), len(now))
        for number, (one, other) in enumerate(zip(before, now, strict=False)):
            yield from _walk(one, other, place.entry(number))
    elif type(before) is not type(now) or repr(before) != repr(now):
        yield _unequal(before, now, place)


def _keys(before: Mapping[str, object], now: Mapping[str, object], place: _Place) -> Iterator[Difference]:
    yield from (place.at(key).differs("missing", before[key], None) for key in before if key not in now)
    yield from (place.at(key).differs("extra", None, now[key]) for key in now if key not in before)
    for key in before:
        if key in now:
            yield from _walk(before[key], now[key], place.at(key))


def _unequal(before: object, now: object, place: _Place) -> Difference:
    if isinstance(before, str) and isinstance(now, str):
        is_text = place.key in PROSE and " " in before and " " in now
        return place.differs("text" if is_text else "value", before, now)
    if _is_number(before) and _is_number(now):
        return place.differs("value", before, now, **_sizes(float(before), float(now)))
    return place.differs("value", before, now)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _sizes(before: float, now: float) -> dict[str, float]:
    apart, larger = abs(before - now), max(abs(before), abs(now))
    return {"relative": apart / larger if larger else 0.0, "ulps": apart / math.ulp(larger)}
