"""Check shapes in the first calls of every function in every test, not in a hundred thousand alike.

A check costs a tenth of a millisecond, which in a whole diagnosis was a third of the time. In a law each
drawn case counts as a test: its shapes differ from those of the last. To make a check costs a millisecond, so
it is made when it is first needed. A function that neither takes nor gives an array has no shapes, and its
types are what mypy proves: it is left as it is.
"""

import functools
from collections.abc import Callable
from dataclasses import dataclass, field, is_dataclass
from typing import Any, get_args

import jaxtyping
from beartype import beartype
from jaxtyping import AbstractArray, install_import_hook

CALLS = 3
"""How often a function is checked in a test."""

make_check = jaxtyping.jaxtyped


@dataclass(eq=False)
class Counter:
    """Count the checked calls of one function in a test."""

    calls: int = 0


@dataclass(eq=False)
class Budget:
    """Hold how many calls are checked, and the functions that the test has called."""

    calls: int = CALLS
    called: list[Counter] = field(default_factory=list)


BUDGET = Budget()
COUNTERS: dict[tuple[str, str], Counter] = {}
"""By module and name: a function inside another is defined again and again."""


def start_test(calls: int = CALLS) -> None:
    """Count anew, and say how many calls of every function are checked."""
    for counter in BUDGET.called:
        counter.calls = 0
    BUDGET.called.clear()
    BUDGET.calls = calls


def start_with_each_case(law: Any) -> None:
    """Let every drawn case of a law count as a test.

    A law that is parametrised is one function; one of steps that are drawn has no cases to begin at.
    """
    inner = getattr(getattr(law, "hypothesis", None), "inner_test", None)
    if inner is None or hasattr(inner, "starts"):
        return

    @functools.wraps(inner)
    def case(*arguments: Any, **drawn: Any) -> None:
        start_test(BUDGET.calls)
        inner(*arguments, **drawn)

    case.starts = True
    law.hypothesis.inner_test = case


def check_packages(names: tuple[str, ...]) -> None:
    """Let the import hook of jaxtyping, which decorates all there is in a package, check first calls."""
    jaxtyping.jaxtyped = lambda *, typechecker: first_calls  # the hook names it
    install_import_hook(names, "beartype.beartype")


def first_calls(what: Any) -> Any:
    """Check the first calls of a function, or those that make an object of a data class."""
    if not isinstance(what, type):
        return _counted(what) if _has_shapes(what) else what
    made = vars(what).get("__init__")
    if is_dataclass(what) and made is not None and not hasattr(made, "__wrapped__") and _has_shapes(made):
        what.__init__ = _counted(made)
    return what


def _counted(function: Callable[..., Any]) -> Callable[..., Any]:
    """Check a function until it was called often enough."""
    counter = COUNTERS.setdefault((function.__module__, function.__qualname__), Counter())
    checked: Callable[..., Any] | None = None

    @functools.wraps(function)
    def counted(*arguments: Any, **options: Any) -> Any:
        nonlocal checked
        if counter.calls >= BUDGET.calls:
            return function(*arguments, **options)
        if not counter.calls:
            BUDGET.called.append(counter)
        counter.calls += 1
        checked = checked or make_check(function, typechecker=_checking)
        return checked(*arguments, **options)

    return counted


def _checking(check: Callable[..., Any]) -> Callable[..., Any]:
    """Make the check of a function's arguments or result, as jaxtyping asks for it.

    That of a result names the arguments once more; their sizes are known by then.
    """
    if check.__annotations__.get("return", Any) is not Any:
        check.__annotations__ = {"return": check.__annotations__["return"]}
    return beartype(check) if _has_shapes(check) else _unchecked


def _unchecked(*_: Any, **__: Any) -> None:
    """Stand for the check of what has no shape."""


def _has_shapes(function: Callable[..., Any]) -> bool:
    return any(map(_has_shape, function.__annotations__.values()))


def _has_shape(annotation: Any) -> bool:
    """Tell whether an annotation names an array; one that is still a text may."""
    if isinstance(annotation, list):  # the arguments of a callable
        return any(map(_has_shape, annotation))
    if isinstance(annotation, type) and issubclass(annotation, AbstractArray):
        return True
    return isinstance(annotation, str) or any(map(_has_shape, get_args(annotation)))
