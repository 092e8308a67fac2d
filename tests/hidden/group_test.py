"""Find which of many changes change an answer, by making many of them at once.

A set of changes that changes no answer is settled at the cost of one pass over the cases, however large it
is. Where a set changes the answer to a case, those that do so alone are taken out of it, in steps that double
while nothing changes and halve where something does. The rest goes on at the same case. Source: Hwang, A
method for detecting all defective members in a population by group testing, JASA 67, 1972.

Two changes of one set can cancel, and one that stops a stage hides what others change in it. A set from which
something was taken is therefore tried again from the first case; what cancels in the last set is not seen.
"""

from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

First = Callable[[tuple[str, ...], range], int | None]
"""Give the first case of a range that a set of changes has answered otherwise, if any."""


class Found(NamedTuple):
    """Hold changes and the first case that each has answered otherwise; None where all together have none."""

    names: tuple[str, ...]
    case: int | None


class Parts(NamedTuple):
    """Divide changes into those that change nothing together, that do so alone, and only beside others."""

    silent: tuple[str, ...]
    alone: tuple[str, ...]
    beside: tuple[str, ...]


def group_test(names: Iterable[str], cases: int, first: First) -> Iterator[Found]:
    """Find the changes that change an answer by themselves, and sets of all others that change none.

    Examples
    --------
    >>> def first(names, cases):
    ...     return 1 if "c" in names and 1 in cases else None
    >>> [("".join(found.names), found.case) for found in group_test("abcdef", 3, first)]
    [('c', 1), ('abdef', None)]
    """
    waiting = [tuple(names)]
    while waiting:
        left, begin, beside = waiting.pop(), 0, ()
        while left and (case := first(left, range(begin, cases))) is not None:
            here = range(case, case + 1)
            parts = divide(left, lambda some, here=here: first(some, here) is not None)
            if parts.alone:
                yield Found(parts.alone, case)
            left, begin, beside = parts.silent, case, (*beside, *parts.beside)
        if left and begin:
            waiting.append(left)
        elif left:
            yield Found(left, None)
        if beside:
            waiting.append(beside)


def divide(names: tuple[str, ...], changes: Callable[[tuple[str, ...]], bool]) -> Parts:
    """Divide a set that changes an answer, such that the rest of it does not.

    Examples
    --------
    >>> divide(tuple("abcdef"), lambda names: "c" in names or {"a", "e"} <= set(names))
    Parts(silent=('a', 'b', 'd', 'f'), alone=('c',), beside=('e',))
    """
    parts, rest, step = Parts((), (), ()), names, max(len(names) // 2, 1)
    while rest:
        block = rest[:step]
        if not changes((*parts.silent, *block)):
            parts, rest, step = parts._replace(silent=(*parts.silent, *block)), rest[step:], 2 * step
        elif len(block) > 1:
            step = len(block) // 2
        elif not parts.silent or changes(block):
            parts, rest = parts._replace(alone=(*parts.alone, *block)), rest[1:]
        else:
            parts, rest = parts._replace(beside=(*parts.beside, *block)), rest[1:]
    return parts
