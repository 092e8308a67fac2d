"""Treat parameter names as data: symbol, number, unit and physical bound in one place.

Positions in a vector are never used as names, because orders differ between tools; whoever wants a parameter
asks for it by name. Sources: Khalil & Dombre, Modeling, Identification and Control of Robots (2002), ch. 9
and 12, for the symbols.
"""

from dataclasses import dataclass

INERTIAL_SYMBOLS = ("XX", "XY", "XZ", "YY", "YZ", "ZZ", "MX", "MY", "MZ", "M")
INERTIAL_UNITS = dict(zip(INERTIAL_SYMBOLS, ("kg m2",) * 6 + ("kg m",) * 3 + ("kg",), strict=True))


@dataclass(frozen=True)
class Parameter:
    """Name one scalar of the model.

    Examples
    --------
    >>> Parameter("ZZ", 3, 3, "kg m2").name
    'ZZ3'
    """

    symbol: str
    """The field's letters, e.g. ``ZZ`` or ``FV``."""
    number: int
    """Joint or link number, counted from 1."""
    joint: int
    """The joint the parameter is reported under, counted from 1."""
    unit: str
    """SI unit as text."""
    lower: float | None = None
    """Physical lower bound, or None where any sign is possible."""

    @property
    def name(self) -> str:
        """Give the symbol with its number."""
        return f"{self.symbol}{self.number}"


def inertial_parameters(link: int, joint: int) -> tuple[Parameter, ...]:
    """Name the ten inertial parameters of a link in Khalil's order.

    Examples
    --------
    >>> [parameter.name for parameter in inertial_parameters(2, 2)][:4]
    ['XX2', 'XY2', 'XZ2', 'YY2']
    """
    return tuple(
        Parameter(symbol, link, joint, INERTIAL_UNITS[symbol], 0.0 if symbol == "M" else None)
        for symbol in INERTIAL_SYMBOLS
    )
