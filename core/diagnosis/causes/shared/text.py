"""Write quantities and numbers for statements and repairs."""

from collections.abc import Mapping, Sequence

from ..protocol import Quantity


def by_name(quantities: Sequence[Quantity]) -> dict[str, Quantity]:
    """Map quantities by their name."""
    return {quantity.name: quantity for quantity in quantities}


def rotor_text(found: Mapping[str, Quantity]) -> str:
    """Write the motor-side inertia of a joint, where it was scanned and is significant."""
    rotor = found.get("motor_inertia")
    if rotor is None or rotor.value <= 2.0 * rotor.standard_deviation:
        return ""
    return f"; motor-side inertia {quantity_text(rotor)}"


def quantity_text(quantity: Quantity) -> str:
    """Write a quantity with its unit and uncertainty."""
    unit = "" if quantity.unit == "1" else f" {quantity.unit}"
    return f"{number_text(quantity.value, 3)} ± {number_text(quantity.standard_deviation)}{unit}"


def number_text(value: float, digits: int = 1) -> str:
    """Write a number with so many significant digits, without an exponent where possible.

    Examples
    --------
    >>> number_text(0.0123), number_text(12.3), number_text(1234.5, 3)
    ('0.01', '10', '1230')
    """
    return f"{float(f'{value:.{digits}g}'):g}"


def clearness(quantity: Quantity) -> float:
    """Give the size of a quantity in standard deviations."""
    return abs(quantity.value) / max(quantity.standard_deviation, 1e-300)
