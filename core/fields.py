"""Read plain data field by field; where one is wrong, say which, what it holds and what it must hold.

Robot descriptions, options and mappings come from outside, so their types are checked. Every refusal carries
a JSON pointer to the spot, and an unknown name is answered with the known ones and the nearest.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from difflib import get_close_matches
from types import NoneType
from typing import TYPE_CHECKING, ClassVar, NoReturn, Self, TypeVar, get_args, get_type_hints

import numpy as np

from .arrays import Matrix, Vector
from .errors import VeritorqueError

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

LONGEST_NAME = 100
LARGEST_NUMBER = 1e30
"""No robot holds such a number; larger ones would overflow in products like mass times distance squared."""
_SCALARS: Mapping[object, tuple[str, str]] = {
    int: ("integer", "a whole number"),
    float: ("number", "a finite number"),
    bool: ("flag", "true or false"),
    str: ("text", "a text"),
}
"""How the scalars of a dataclass are read, and what they must hold."""
Record = TypeVar("Record", bound="DataclassInstance")


class Fields:
    """Read the fields of one object.

    Parameters
    ----------
    value
        What stands at this place; anything but a mapping is refused.
    where
        The place in words, e.g. ``joint 3``.
    pointer
        The place as a JSON pointer.
    meanings
        Every field that may stand here, with what it must hold.

    Raises
    ------
    VeritorqueError
        Of the class `error`, where the value is no object or holds a field that does not exist.
    """

    error: ClassVar[type[VeritorqueError]] = VeritorqueError
    """Class of the refusals."""
    largest: ClassVar[float] = LARGEST_NUMBER
    longest: ClassVar[int] = LONGEST_NAME
    """Largest magnitude of a number, greatest length of a text."""
    elsewhere: ClassVar[Mapping[str, str]] = {}
    """Names that other documents give to such fields, each with what to do."""
    holds: ClassVar[str] = "given"
    """Name of a refused value in the evidence."""

    def __init__(self, value: object, where: str, pointer: str, meanings: Mapping[str, str]) -> None:
        self.where, self.pointer, self.meanings = where, pointer, meanings
        if not isinstance(value, Mapping):
            raise self.error(
                f"{where} is not an object",
                evidence={"pointer": pointer, self.holds: shown(value)},
                remedy="give an object with " + ", ".join(meanings),
            )
        unknown = [str(name)[:LONGEST_NAME] for name in value if name not in meanings]
        if unknown:
            raise self.error(
                f"{where} holds a field that does not exist: {unknown[0]}",
                evidence={
                    "pointer": pointer,
                    "unknown": unknown[:5],
                    "known": list(meanings),
                    "nearest": get_close_matches(unknown[0], list(meanings)),
                },
                remedy=next(
                    filter(None, map(self.elsewhere.get, unknown)),
                    "leave it out or spell it as one of the known fields",
                ),
            )
        self.value = value

    def refuse(self, name: str, problem: str, **evidence: object) -> NoReturn:
        """Raise the error for one field."""
        evidence = {"pointer": f"{self.pointer}/{name}", "field": name} | evidence
        if name in self.value:
            evidence[self.holds] = shown(self.value[name])
        raise self.error(
            f"{self.where}: {name} {problem}",
            evidence=evidence,
            remedy=f"give {name} as {self.meanings[name]}",
        )

    def required(self, name: str) -> object:
        """Give the field's value as it stands; refuse its absence and name what must stand here."""
        if name not in self.value:
            raise self.error(
                f"{self.where}: {name} is missing",
                evidence={"pointer": self.pointer, "field": name, "given": [str(key) for key in self.value]},
                remedy=f"give {name} as {self.meanings[name]}",
            )
        return self.value[name]

    def has(self, name: str) -> bool:
        """Tell whether the field is there and not null."""
        return self.value.get(name) is not None

    def inner(self, name: str, meanings: Mapping[str, str], where: str = "") -> Self:
        """Read an object inside this one; an absent one and null are empty."""
        value = self.value[name] if self.has(name) else {}
        return type(self)(value, where or name, f"{self.pointer}/{name}", meanings)

    def number(self, name: str, default: float | None = None) -> float:
        """Read a finite number; without a default the field is required."""
        if name not in self.value and default is not None:
            return default
        return self._finite(name, self.required(name))

    def optional_number(self, name: str, *, positive: bool = False) -> float | None:
        """Read a finite number that is not zero, or None; where `positive`, not below zero either."""
        if not self.has(name):
            return None
        number = self._finite(name, self.value[name])
        if number == 0.0 or (positive and number < 0.0):
            self.refuse(name, "is out of range")
        return number

    def integer(self, name: str, bounds: tuple[float, float] = (-np.inf, np.inf)) -> int:
        """Read a whole number within bounds, both included."""
        return self._whole(name, self.required(name), bounds)

    def flag(self, name: str) -> bool:
        """Read true or false."""
        value = self.required(name)
        if not isinstance(value, bool):
            self.refuse(name, "is neither true nor false")
        return value

    def text(self, name: str) -> str:
        """Read a printable text that is not too long."""
        value = self.required(name)
        if not isinstance(value, str) or not value.isprintable() or not 1 <= len(value) <= self.longest:
            self.refuse(name, f"is not a printable text of 1 to {self.longest} characters")
        if value.isspace():
            self.refuse(name, "holds nothing but blanks")
        return value

    def choice(self, name: str, options: Sequence[str]) -> str:
        """Read one of several words."""
        value = self.required(name)
        if not isinstance(value, str) or value not in options:
            self.refuse(name, f"is not one of {', '.join(options)}")
        return value

    def items(self, name: str, *, least: int = 0, most: float = np.inf) -> Sequence[object]:
        """Read a list whose length lies within bounds, both included."""
        return self._list(name, self.required(name), (least, most))

    def integers(
        self,
        name: str,
        bounds: tuple[float, float] = (-np.inf, np.inf),
        *,
        least: int = 0,
        most: float = np.inf,
    ) -> tuple[int, ...]:
        """Read a list of whole numbers within bounds, both included."""
        return tuple(self._whole(name, item, bounds) for item in self.items(name, least=least, most=most))

    def numbers(self, name: str, count: int) -> Vector:
        """Read a list of so many finite numbers."""
        return self._numbers(name, self.required(name), count)

    def rows(self, name: str, width: int, *, least: int = 0, most: float = np.inf) -> Matrix:
        """Read a list of rows of so many finite numbers."""
        listed = self.items(name, least=least, most=most)
        return np.array([self._numbers(name, row, width) for row in listed]).reshape(-1, width)

    def record(self, default: Record, **read: object) -> Record:
        """Read the scalars of a frozen dataclass; what is absent or null stays as in `default`.

        Parameters
        ----------
        **read
            Fields of the dataclass that were read otherwise.
        """
        for name, kind in scalars(type(default)).items():
            if name in self.meanings and self.has(name):
                read[name] = getattr(self, _SCALARS[kind][0])(name)
        return replace(default, **read)

    def _list(self, name: str, value: object, bounds: tuple[int, float]) -> Sequence[object]:
        if isinstance(value, str | bytes) or not isinstance(value, Sequence):
            self.refuse(name, "is not a list")
        least, most = bounds
        if not least <= len(value) <= most:
            upper = "" if least == most else f" to {most}"
            length = f"at least {least}" if most == np.inf else f"{least}{upper}"
            self.refuse(name, f"holds {len(value)} entries and must hold {length}")
        return value

    def _numbers(self, name: str, value: object, count: int) -> Vector:
        return np.array([self._finite(name, item) for item in self._list(name, value, (count, count))])

    def _whole(self, name: str, value: object, bounds: tuple[float, float]) -> int:
        if isinstance(value, float) and value.is_integer():
            value = int(value)  # JSON has one kind of number, and some programs write 1 as 1.0
        if isinstance(value, bool) or not isinstance(value, int):
            self.refuse(name, "is not a whole number")
        if not bounds[0] <= value <= bounds[1]:
            self.refuse(name, f"is not between {bounds[0]} and {bounds[1]}")
        return value

    def _finite(self, name: str, value: object) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float):
            self.refuse(name, "is not a number")
        try:
            number = float(value)
        except OverflowError:
            number = np.inf
        if not np.isfinite(number):
            self.refuse(name, "is not finite")
        if abs(number) > self.largest:
            self.refuse(name, f"is beyond {self.largest:g} in size")
        return number


def scalars(record: type) -> dict[str, object]:
    """List the scalar fields of a dataclass with their types; an optional one has its type without None."""
    kinds = get_type_hints(record)
    plain = {
        name: next((kind for kind in get_args(hint) if kind is not NoneType), hint)
        if NoneType in get_args(hint)
        else hint
        for name, hint in kinds.items()
    }
    return {name: kind for name, kind in plain.items() if kind in _SCALARS}


def scalar_meanings(record: type) -> dict[str, str]:
    """Say what the scalar fields of a dataclass must hold.

    Examples
    --------
    >>> from veritorque.core.validation.holdout import HoldOut
    >>> scalar_meanings(HoldOut)
    {'fraction': 'a finite number', 'blocks': 'a whole number'}
    """
    return {name: _SCALARS[kind][1] for name, kind in scalars(record).items()}


def shown(value: object) -> str:
    """Show a value of any kind in at most eighty characters.

    Examples
    --------
    >>> shown({"alpha": None})
    "{'alpha': None}"
    """
    try:
        text = repr(value)
    except (RecursionError, ValueError):
        text = type(value).__name__
    return text if len(text) <= 80 else text[:77] + "..."
