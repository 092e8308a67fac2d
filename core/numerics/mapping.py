"""Apply a function to independent items; who starts a computation decides whether one after the other."""

from collections.abc import Callable, Iterable
from typing import Protocol, TypeVar, runtime_checkable

Item = TypeVar("Item")
Answer = TypeVar("Answer")


@runtime_checkable
class Mapper(Protocol):
    """Map a function over items, in their order: draws of a bootstrap, starts of a search, candidates."""

    def map(self, function: Callable[[Item], Answer], items: Iterable[Item]) -> list[Answer]:
        """Give one answer per item."""


class SerialMapper:
    """Work on one item after the other."""

    def map(self, function: Callable[[Item], Answer], items: Iterable[Item]) -> list[Answer]:
        """Give one answer per item."""
        return [function(item) for item in items]


SERIAL = SerialMapper()
