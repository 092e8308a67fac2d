"""Check shapes in the first calls of every function in every test, not in a hundred thousand alike.

A check costs a tenth of a millisecond, which in a whole diagnosis was a third of the time. A law over drawn
cases is checked in every call: its shapes differ from one case to the next. To make a check costs a
millisecond: it is made when it is first needed, which for a function inside another is in its first calls,
too, and not whenever it is defined anew. Arguments or results of which none is an array have no shape, and
their types are what mypy proves: a function with neither is never checked.
"""

import inspect
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from types import FunctionType
from typing import Any, get_args

from beartype import beartype
from jaxtyping import AbstractArray

CALLS = 10
"""How often a function is checked in a test."""


@dataclass(eq=False)
class Counter:
    """Count the checks of one function's arguments or result in a test."""

    module: str
    name: str
    calls: int = 0

    def let(self, *, unchecked: bool) -> None:
        """Let the function be checked or not; one that is defined inside another cannot be found."""
        function = _function(self.module, self.name)
        if function is not None:
            function.__dict__["__no_type_check__"] = unchecked


@dataclass(eq=False)
class Budget:
    """Hold how many calls are checked, and the functions that the test has called."""

    calls: int | None = CALLS
    called: list[Counter] = field(default_factory=list)


BUDGET = Budget()
COUNTERS: dict[tuple[str, str, bool], Counter] = {}
"""Of every function by module and name, of its arguments and of its result."""
RESULTS: set[tuple[str, str]] = set()
"""Functions by module and name whose results have shapes."""


def first_calls(check: Callable[..., Any]) -> Callable[..., Any]:
    """Make the check of a function's arguments or result, as the import hook asks for it.

    That of a result names the arguments once more; their sizes are known by then.
    """
    if "return" not in check.__annotations__:  # to find which argument it is that was refused
        return beartype(check)
    of_result = check.__annotations__["return"] is not Any
    if of_result:
        check.__annotations__ = {"return": check.__annotations__["return"]}
    module, name = check.__module__, check.__qualname__
    if not any(map(_has_shape, check.__annotations__.values())):
        return _unchecked(module, name, of_result=of_result)
    if of_result:
        RESULTS.add((module, name))
    return _counted(check, COUNTERS.setdefault((module, name, of_result), Counter(module, name)))


def _counted(check: Callable[..., Any], counter: Counter) -> Callable[..., Any]:
    """Make the check when it is first needed, and no more when it was needed often enough."""
    checked: Callable[..., Any] | None = None

    def counted(*arguments: Any, **options: Any) -> Any:
        nonlocal checked
        if not counter.calls:
            BUDGET.called.append(counter)
        counter.calls += 1
        if BUDGET.calls is not None and counter.calls >= BUDGET.calls:
            counter.let(unchecked=True)
            if counter.calls > BUDGET.calls:
                return None
        checked = checked or beartype(check)
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


def _has_shape(annotation: Any) -> bool:
    """Tell whether an annotation names an array; one that is still a text may."""
    if isinstance(annotation, list):  # the arguments of a callable
        return any(map(_has_shape, annotation))
    if isinstance(annotation, type) and issubclass(annotation, AbstractArray):
        return True
    return isinstance(annotation, str) or any(map(_has_shape, get_args(annotation)))


def _unchecked(module: str, name: str, *, of_result: bool) -> Callable[..., Any]:
    """Check nothing of a function's arguments or result, and nothing at all where neither has a shape.

    The check of a result is made before that of the arguments.
    """
    spared = not of_result and (module, name) not in RESULTS

    def unchecked(*_: Any, **__: Any) -> Any:
        nonlocal spared
        if spared:
            Counter(module, name).let(unchecked=True)
            spared = False

    return unchecked


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
