"""Write numbers, joints and coordinates as text; the page rounds only here."""

from collections.abc import Mapping, Sequence
from math import floor, log10
from typing import Any

Number = float | int | None
Document = Mapping[str, Any]
"""A result document, or a part of one."""
_SMALLEST_GAIN = 1.0
"""Percent."""
_SMALLEST, _LARGEST = 0.1, 1000
"""Percentages outside are given as bounds."""
MINUS = "\N{MINUS SIGN}"
_NO_BREAK_SPACE = "\N{NO-BREAK SPACE}"
NOTHING = "-"
"""Placeholder of a missing number."""
_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_COUNTS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine")
_COORDINATES = {
    "time": "time",
    "position": "position",
    "velocity": "velocity",
    "acceleration": "acceleration",
    "load": "predicted transmitted torque",
    "torque": "predicted torque",
    "torque_rate": "predicted torque rate",
    "travel": "travel since the last reversal",
    "motor_phase": "motor angle",
    "temperature": "temperature",
}
_QUANTITIES = {
    "std": "standard deviation",
    "lsb": "resolution",
    "harmonic": "cycles per revolution",
    "com_x": "centre of mass, x",
    "com_y": "centre of mass, y",
    "com_z": "centre of mass, z",
    "Fvm": "viscous friction of the motor",
    "Fcm": "Coulomb friction of the motor",
    "Iam": "inertia of the motor",
}
_NAMES = ("Coulomb", "Stribeck")
"""Proper names at the beginning of titles."""
_CORRECTED = {
    "term": "the model (an additional term)",
    "signal": "a channel of the log",
    "robot": "the robot description",
}


def number(value: Number, digits: int = 3) -> str:
    """Write significant digits, with a power of ten for very small and large numbers.

    Examples
    --------
    >>> number(0.01234), number(1.2e-7), number(None), number(12345.0)
    ('0.0123', '1.2·10⁻⁷', '-', '12345')
    """
    if value is None:
        return NOTHING
    if value and not 1e-4 <= abs(value) < 1e6:
        mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
        mantissa = mantissa.rstrip("0").rstrip(".") if "." in mantissa else mantissa
        return f"{mantissa}·10{str(int(exponent)).translate(_SUPERSCRIPTS)}".replace("-", MINUS)
    decimals = max(digits - 1 - floor(log10(abs(value))), 0) if value else 0
    return f"{value:.{decimals}f}".replace("-", MINUS)


def uncertain(value: Number, deviation: Number, unit: str = "1") -> str:
    """Write a value with its standard deviation, rounded to two digits of the deviation.

    Examples
    --------
    >>> uncertain(0.09953, 0.00206, "N m"), uncertain(9.04, 0.1)
    ('0.0995 ± 0.0021 N m', '9.04 ± 0.10')
    """
    after = "" if unit in ("1", "") else f" {unit}"
    if value is None or not deviation or not 1e-12 < deviation < 1e9:
        return number(value) + after
    decimals = max(1 - floor(log10(deviation)), 0)
    if decimals > 6:
        return f"{number(value)} ± {number(deviation, 2)}{after}"
    return f"{value:.{decimals}f} ± {deviation:.{decimals}f}{after}".replace("-", MINUS)


def percent(value: Number) -> str:
    """Write a percentage, or a bound if it is very small or large.

    Examples
    --------
    >>> percent(3.14159), percent(66.8), percent(0.0)
    ('3.1 %', '67 %', '0 %')
    >>> percent(2e-8), percent(2.07e9)
    ('< 0.1 %', '> 1000 %')
    """
    if value is None:
        return NOTHING
    if 0.0 < abs(value) < 0.5 * _SMALLEST:
        return f"{'<' if value > 0.0 else '>'} {MINUS * (value < 0.0)}{_SMALLEST} %"
    if abs(value) > _LARGEST:
        return f"{'>' if value > 0.0 else '<'} {MINUS * (value < 0.0)}{_LARGEST} %"
    shown = f"{value:.0f}" if not value or abs(value) >= 10.0 else f"{value:.1f}"
    return f"{shown} %".replace("-", MINUS)


def share(fraction: Number) -> str:
    """Write a fraction as a percentage.

    Examples
    --------
    >>> share(0.41), share(None)
    ('41 %', '-')
    """
    return percent(None if fraction is None else 100.0 * fraction)


def interval(ends: Sequence[Number] | None) -> str:
    """Write an interval of percentages.

    Examples
    --------
    >>> interval([53.6, 74.2]), interval([-0.001, 0.2]), interval(None)
    ('54 to 74 %', '0 to 0.2 %', '-')
    """
    if ends is None or None in ends:
        return NOTHING
    low, high = (percent(None if end is None else round(end, 1) + 0.0).removesuffix(" %") for end in ends)
    return f"{low} to {high} %"


def p_value_text(p_value: Number) -> str:
    """Write a p-value, bounded below by 10⁻³⁰⁰.

    Examples
    --------
    >>> p_value_text(0.0), p_value_text(2e-9), p_value_text(0.2)
    ('< 10⁻³⁰⁰', '2·10⁻⁹', '0.20')
    """
    if p_value is None:
        return NOTHING
    if p_value < 1e-300:
        return "< 10⁻³⁰⁰"
    return number(p_value, 2)


def is_significant(gain: Number, ends: Sequence[Number] | None, *, sign: float = 1.0) -> bool:
    """Decide whether an improvement (or, by `sign`, a loss), in percent, is significant and above 1 %.

    Examples
    --------
    >>> is_significant(40.0, [30.0, 50.0]), is_significant(40.0, [-1.0, 81.0])
    (True, False)
    """
    if gain is None or ends is None:
        return False
    return sign * gain > _SMALLEST_GAIN and all(end is not None and sign * end > 0.0 for end in ends)


def joints(numbers: Sequence[int]) -> str:
    """Name one or several joints.

    Examples
    --------
    >>> joints([2]), joints([5, 6]), joints([])
    ('joint 2', 'joints 5 and 6', 'the whole robot')
    """
    if not numbers:
        return "the whole robot"
    return f"joint{'s' if len(numbers) > 1 else ''} {series([str(joint) for joint in numbers])}"


def series(items: Sequence[str]) -> str:
    """Join words by commas and a last "and".

    Examples
    --------
    >>> series(["a"]), series(["a", "b", "c"])
    ('a', 'a, b and c')
    """
    return items[0] if len(items) == 1 else f"{', '.join(items[:-1])} and {items[-1]}"


def count(size: int) -> str:
    """Write a small number as a word."""
    return _COUNTS[size] if size < len(_COUNTS) else str(size)


def lower(sentence: str) -> str:
    """Begin with a small letter, except for proper names.

    Examples
    --------
    >>> lower("Joint elasticity"), lower("Stribeck friction")
    ('joint elasticity', 'Stribeck friction')
    """
    return sentence if sentence.startswith(_NAMES) else sentence[:1].lower() + sentence[1:]


def quantity(name: str) -> str:
    """Describe a parameter of a finding.

    Examples
    --------
    >>> quantity("load_coefficient"), quantity("std")
    ('load coefficient', 'standard deviation')
    """
    return _QUANTITIES.get(name, name.replace("_", " "))


def unit(name: str) -> str:
    """Write a unit with raised powers; empty without a unit.

    Examples
    --------
    >>> unit("kg m2"), unit("1"), unit("N m/rad")
    ('kg m²', '', 'N m/rad')
    """
    return "" if name == "1" else name.replace("m2", "m²")


def no_break(sentence: str) -> str:
    """Join numbers and units by no-break spaces.

    Examples
    --------
    >>> len("by 0.1 N m".split(" ")), len(no_break("by 0.1 N m").split(" "))
    (4, 2)
    """
    return sentence.replace(" N m", f"{_NO_BREAK_SPACE}N{_NO_BREAK_SPACE}m").replace(
        " %", f"{_NO_BREAK_SPACE}%"
    )


def coordinate(name: str, joint: int) -> str:
    """Describe the abscissa of a figure.

    Examples
    --------
    >>> coordinate("position", 4), coordinate("velocity_of_joint_2", 3)
    ('position of joint 4', 'velocity of joint 2')
    """
    if name.startswith("velocity_of_joint_"):
        return f"velocity of joint {name.removeprefix('velocity_of_joint_')}"
    words = _COORDINATES.get(name, name.replace("_", " "))
    return words if name in ("time", "temperature") else f"{words} of joint {joint}"


def corrected_object(kind: str) -> str:
    """Describe what is corrected for a finding."""
    return _CORRECTED.get(kind, kind)


def reference(document: Document) -> str | None:
    """Describe the reference of a diagnosis; None if the model was identified from the logs.

    Examples
    --------
    >>> reference({"diagnosis": {"reference": {"name": "prior"}}}), reference({"diagnosis": {}})
    ('its own description', None)
    """
    found = document["diagnosis"].get("reference")
    if not found:
        return None
    return "its own description" if found["name"] == "prior" else f"the result of {found['name']}"


def band(document: Document) -> str:
    """Give the upper frequency limit of a diagnosis.

    Examples
    --------
    >>> band({"diagnosis": {"band_hz": 17.52}})
    'up to 17.5 Hz'
    """
    return f"up to {number(document['diagnosis'].get('band_hz'))} Hz"


def fit_band(document: Document) -> str:
    """Give the upper frequency limits of the fit.

    Examples
    --------
    >>> fit_band({"logs": [{"filter": {"cutoff_hz": 5.01}}, {"filter": {"cutoff_hz": 6.2}}]})
    'up to 5.01 and 6.20 Hz'
    """
    cutoffs = sorted({number((log.get("filter") or {}).get("cutoff_hz")) for log in document["logs"]})
    return f"up to {series(cutoffs)} Hz"
