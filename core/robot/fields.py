"""Read a description field by field and, where one is wrong, say which, what it holds and what it must hold.

Descriptions come from outside, so nothing about their types is believed; every refusal carries a JSON pointer
to the spot.
"""

from collections.abc import Mapping, Sequence
from typing import NoReturn

import numpy as np

from ..errors import RobotError

LONGEST_NAME = 100
LARGEST_NUMBER = 1e30
"""No robot holds such a number; larger ones would overflow in products like mass times distance squared."""


class Fields:
    """Read the fields of one object of a description.

    Parameters
    ----------
    value
        What the description holds at this place; anything but a mapping is refused.
    where
        The place in words, e.g. ``joint 3``.
    pointer
        The place as a JSON pointer.
    meanings
        Every field that may stand here, with what it must hold.

    Raises
    ------
    RobotError
        Where the value is no object or holds a field that does not exist.
    """

    def __init__(self, value: object, where: str, pointer: str, meanings: Mapping[str, str]) -> None:
        self.where, self.pointer, self.meanings = where, pointer, meanings
        if not isinstance(value, Mapping):
            raise RobotError(
                f"{where} is not an object",
                evidence={"pointer": pointer, "given": shown(value)},
                remedy="give an object with " + ", ".join(meanings),
            )
        unknown = [str(name)[:LONGEST_NAME] for name in value if name not in meanings]
        if unknown:
            raise RobotError(
                f"{where} holds a field that does not exist: {unknown[0]}",
                evidence={"pointer": pointer, "unknown": unknown[:5], "known": list(meanings)},
                remedy="leave it out or spell it as one of the known fields",
            )
        self.value = value

    def refuse(self, name: str, problem: str) -> NoReturn:
        """Raise the error for one field."""
        evidence: dict[str, object] = {"pointer": f"{self.pointer}/{name}", "field": name}
        if name in self.value:
            evidence["given"] = shown(self.value[name])
        raise RobotError(
            f"{self.where}: {name} {problem}",
            evidence=evidence,
            remedy=f"give {name} as {self.meanings[name]}",
        )

    def has(self, name: str) -> bool:
        """Tell whether the field is there and not null."""
        return self.value.get(name) is not None

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

    def integer(self, name: str, bounds: tuple[int, int], default: int | None = None) -> int:
        """Read a whole number within bounds, both included."""
        if name not in self.value and default is not None:
            return default
        number = self.required(name)
        if isinstance(number, bool) or not isinstance(number, int):
            self.refuse(name, "is not a whole number")
        if not bounds[0] <= number <= bounds[1]:
            self.refuse(name, f"is not between {bounds[0]} and {bounds[1]}")
        return number

    def flag(self, name: str, *, default: bool) -> bool:
        """Read true or false."""
        value = self.value.get(name, default)
        if not isinstance(value, bool):
            self.refuse(name, "is neither true nor false")
        return value

    def text(self, name: str, default: str | None = None) -> str:
        """Read a printable name of at most 100 characters."""
        value = default if name not in self.value and default is not None else self.required(name)
        if not isinstance(value, str) or not value.isprintable() or not 1 <= len(value) <= LONGEST_NAME:
            self.refuse(name, f"is not a printable text of 1 to {LONGEST_NAME} characters")
        if value.isspace():
            self.refuse(name, "holds nothing but blanks")
        return value

    def choice(self, name: str, options: Sequence[str], default: str | None = None) -> str:
        """Read one of several words."""
        value = default if name not in self.value and default is not None else self.required(name)
        if not isinstance(value, str) or value not in options:
            self.refuse(name, f"is not one of {', '.join(options)}")
        return value

    def items(self, name: str, *, least: int = 0, most: int) -> Sequence[object]:
        """Read a list whose length lies within bounds, both included."""
        value = self.required(name)
        if isinstance(value, str | bytes) or not isinstance(value, Sequence):
            self.refuse(name, "is not a list")
        if not least <= len(value) <= most:
            length = str(least) if least == most else f"{least} to {most}"
            self.refuse(name, f"holds {len(value)} entries and must hold {length}")
        return value

    def numbers(self, name: str, count: int) -> np.ndarray:
        """Read a list of so many finite numbers."""
        return np.array([self._finite(name, one) for one in self.items(name, least=count, most=count)])

    def required(self, name: str) -> object:
        """Give the field's value as it stands; refuse its absence and name what must stand here."""
        if name not in self.value:
            raise RobotError(
                f"{self.where}: {name} is missing",
                evidence={"pointer": self.pointer, "field": name, "given": [str(key) for key in self.value]},
                remedy=f"give {name} as {self.meanings[name]}",
            )
        return self.value[name]

    def _finite(self, name: str, value: object) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float):
            self.refuse(name, "is not a number")
        try:
            number = float(value)
        except OverflowError:
            number = np.inf
        if not np.isfinite(number):
            self.refuse(name, "is not finite")
        if abs(number) > LARGEST_NUMBER:
            self.refuse(name, f"is beyond {LARGEST_NUMBER:g} in size")
        return number


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
