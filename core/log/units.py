"""List the units in which logs come and what turns each into SI; log units are converted nowhere else.

Default names are SI by contract; everything else declares its unit, because a wrong guess would be a wrong
robot.
"""

from dataclasses import dataclass
from math import pi


@dataclass(frozen=True)
class Unit:
    """Turn a value into SI: `factor * (value + offset)`.

    Examples
    --------
    >>> UNITS["temperature"]["K"].offset
    -273.15
    """

    factor: float = 1.0
    offset: float = 0.0
    needs_scale: bool = False


SI = Unit()
COUNTS = Unit(needs_scale=True)

UNITS: dict[str, dict[str, Unit]] = {
    "time": {"s": SI, "ms": Unit(1e-3), "us": Unit(1e-6), "ns": Unit(1e-9)},
    "position": {"rad": SI, "deg": Unit(pi / 180), "m": SI, "mm": Unit(1e-3), "counts": COUNTS},
    "velocity": {"rad/s": SI, "deg/s": Unit(pi / 180), "rpm": Unit(pi / 30), "m/s": SI, "mm/s": Unit(1e-3)},
    "torque": {"N m": SI, "mN m": Unit(1e-3), "N": SI, "counts": COUNTS},
    "current": {"A": SI, "mA": Unit(1e-3)},
    "temperature": {"degC": SI, "K": Unit(1.0, -273.15)},
}
"""Units by channel. `counts` is whatever one count is declared to be by `scale`: rad, or N m."""

PREFIXES = {
    "position": "q",
    "velocity": "qd",
    "torque": "tau",
    "current": "current",
    "temperature": "temperature",
}
"""Default column names are the prefix, an underscore and the joint's number from 1."""

TIME = "time"

ANGLE_OR_WAY, TORQUE_OR_FORCE = "rad (slide: m)", "N m (slide: N)"
"""SI units of position and torque in words: a log does not know which of its joints slide."""
