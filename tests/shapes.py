"""Check shapes in the first calls of every function in every test, not in a hundred thousand alike.

A check costs a tenth of a millisecond, which in a whole diagnosis was a third of the time. A law over drawn
cases is checked in every call: its shapes differ from one case to the next.
"""

import inspect
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from types import FunctionType
from typing import Any

from beartype import beartype

CALLS = 50
"""How often a function is checked in a test."""


@dataclass(eq=False)
class Counter:
    """Count the checks of one function's arguments or result in a test."""

    module: str
    name: str
    calls: int = 0

    def let(self, *, unchecked: bool) -> None:
        """Let the function be checked or not; one that is defined inside another always is."""
        function = _function(self.module, self.name)
        if function is not None:
            function.__dict__["__no_type_check__"] = unchecked


@dataclass(eq=False)
class Budget:
    """Hold how many calls are checked, and the functions that the test has called."""

    calls: int | None = CALLS
    called: list[Counter] = field(default_factory=list)


BUDGET = Budget()


def first_calls(check: Callable[..., Any]) -> Callable[..., Any]:
    """Make the check of a function's arguments or result, as the import hook asks for it."""
    checked = beartype(check)
    counter = Counter(check.__module__, check.__qualname__)

    def counted(*arguments: Any, **options: Any) -> Any:
        if not counter.calls:
            BUDGET.called.append(counter)
        counter.calls += 1
        if counter.calls == BUDGET.calls:
            counter.let(unchecked=True)
        return checked(*arguments, **options)

    return counted


def start_test(*, of_a_law: bool) -> None:
    """Count anew; in a law over drawn cases every call is checked."""
    for counter in BUDGET.called:
        if BUDGET.calls is not None and counter.calls >= BUDGET.calls:
            counter.let(unchecked=False)
        counter.calls = 0
    BUDGET.called.clear()
    BUDGET.calls = None if of_a_law else CALLS


def _function(module: str, name: str) -> FunctionType | None:
    """Find the function behind its checks."""
    found: Any = sys.modules.get(module)
    for part in name.split("."):
        found = inspect.getattr_static(found, part, None)
    if isinstance(found, property):
        found = found.fget
    found = getattr(found, "__func__", getattr(found, "func", found))
    inner = getattr(found, "__wrapped__", None)
    return inner if isinstance(inner, FunctionType) else None
