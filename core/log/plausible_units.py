"""Say in which units a column could plausibly be, with the numbers that speak for it; never decide.

A column of positions that spans 340 is degrees to any reader, yet converting it silently would hide the one
case where it is not. So the readings are ranked and shown, and whoever knows the robot declares one.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Vector
from .units import COUNTS, UNITS


@dataclass(frozen=True)
class Reading:
    """Name a unit, the sizes that are usual in it, and why."""

    unit: str
    low: float
    high: float
    reason: str


READINGS: dict[str, tuple[Reading, ...]] = {
    "position": (
        Reading("rad", 0.02, 13.0, "a joint seldom turns more than two turns either way"),
        Reading("deg", 13.0, 1500.0, "a joint turns some hundred degrees"),
        Reading("counts", 1000.0, np.inf, "whole numbers of this size are encoder counts"),
        Reading("mm", 13.0, 5000.0, "a slide travels some hundred millimetres"),
        Reading("m", 0.005, 5.0, "a slide travels some metres at most"),
    ),
    "velocity": (
        Reading("rad/s", 0.01, 12.0, "a joint turns some rad per second"),
        Reading("deg/s", 12.0, 700.0, "a joint turns some hundred degrees per second"),
        Reading("rpm", 100.0, 10000.0, "a motor turns some thousand times per minute"),
        Reading("m/s", 0.005, 5.0, "a slide moves some metres per second at most"),
        Reading("mm/s", 12.0, 5000.0, "a slide moves some hundred millimetres per second"),
    ),
    "torque": (
        Reading("N m", 0.05, 3000.0, "a joint needs some newton metres"),
        Reading("counts", 100.0, np.inf, "whole numbers of this size are counts of a drive"),
        Reading("mN m", 3000.0, 3e6, "a joint needs some thousand millinewton metres"),
        Reading("N", 0.5, 10000.0, "a slide needs some newtons"),
    ),
    "current": (
        Reading("A", 0.02, 80.0, "a motor draws some amperes"),
        Reading("mA", 80.0, 80000.0, "a motor draws some thousand milliamperes"),
    ),
    "temperature": (
        Reading("degC", -20.0, 150.0, "a joint is between frost and 150 degrees Celsius"),
        Reading("K", 250.0, 430.0, "a joint is some 300 kelvin warm"),
    ),
    "time": (
        Reading("s", 1e-5, 0.15, "a log is sampled at 10 Hz to 100 kHz"),
        Reading("ms", 0.15, 150.0, "a log is sampled at 10 Hz to 10 kHz"),
        Reading("us", 50.0, 1.5e5, "a log is sampled at 10 Hz to 20 kHz"),
        Reading("ns", 5e4, 1.5e8, "a log is sampled at 10 Hz to 20 kHz"),
    ),
}
"""Usual sizes by channel: the largest magnitude of the column, or the median step of time."""


def plausible_readings(channel: str, values: Vector) -> list[str]:
    """Rank the units in which these values make sense.

    Parameters
    ----------
    channel
        One of the channels of `UNITS`.
    values
        Samples of one column, in the unit that is asked for.

    Returns
    -------
    list of str
        One sentence per plausible unit, the most plausible first; empty if none is.

    Examples
    --------
    >>> plausible_readings("position", np.array([-170.5, 169.5]))[0]
    'deg: values reach 170.5 and span 340; a joint turns some hundred degrees'
    """
    finite = values[np.isfinite(values)]
    if len(finite) == 0:
        return []
    whole = bool(np.all(finite == np.round(finite)))
    steps = np.diff(finite)
    size = float(np.median(steps)) if channel == "time" and len(steps) else float(np.max(np.abs(finite)))
    seen = (
        f"the median step is {size:.4g}"
        if channel == "time"
        else f"values reach {size:.4g} and span {np.ptp(finite):.4g}"
    )
    fitting = [
        reading
        for reading in READINGS[channel]
        if reading.low <= size < reading.high and (whole or UNITS[channel][reading.unit] != COUNTS)
    ]
    if whole:  # whole numbers speak for counts before anything else
        fitting.sort(key=lambda reading: UNITS[channel][reading.unit] != COUNTS)
    return [f"{reading.unit}: {seen}; {reading.reason}" for reading in fitting]
