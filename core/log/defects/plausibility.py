"""Find numbers that are unlikely in their declared unit, and channels that measure nothing.

Nothing is converted here: numbers of the size of degrees are reported as such, and the user decides.
"""

import numpy as np

from ..channels import EFFORTS, UNITS
from ..model import Defect
from .stretch import Facts

LARGEST_SPAN = 13.0
"""A revolute joint that moves from minus one turn to plus one spans 12.6 rad."""
FEWEST_COUNTS = 100.0
"""Whole numbers up to less than this may be a coarse sensor's."""
RATES_HZ = (2.0, 1e5)
SHORTEST_SECONDS = 10.0


def plausibility_defects(facts: Facts) -> list[Defect]:
    """State what the extremes, the rate and the length of the log show."""
    return [*_positions(facts), *_efforts(facts), *_missing_torques(facts), *_times(facts), *_short(facts)]


def _positions(facts: Facts) -> list[Defect]:
    found = []
    for joint, span in enumerate(facts.span("position")):
        if span > LARGEST_SPAN:
            statement = (
                f"Joint {joint + 1} spans {span:.4g} rad, which is {span / (2 * np.pi):.3g} revolutions; "
                f"read as degrees it would be {np.deg2rad(span):.3g} rad, and at a prismatic joint, read as "
                f"millimetres, {1e-3 * span:.3g} m. Where it is the motor's angle, map "
                "it with the scale 1 / gear ratio, and the motor's torque with the gear ratio. Nothing was "
                "converted."
            )
            found.append(Defect("implausible_unit", "position", joint + 1, facts.samples, (), statement))
    return found


def _efforts(facts: Facts) -> list[Defect]:
    """State torques and currents beyond what is usual by the table of channels, and whole numbers."""
    found = []
    for channel in EFFORTS:
        if channel not in facts.low:
            continue
        largest = np.maximum(np.abs(facts.low[channel]), np.abs(facts.high[channel]))
        for joint, size in enumerate(map(float, largest)):
            whole = bool(facts.whole[channel][joint])
            if what := _unusual(channel, size, facts.units[channel][joint], whole=whole):
                statement = f"Joint {joint + 1}'s {channel} {what}. Nothing was converted."
                found.append(Defect("implausible_unit", channel, joint + 1, facts.samples, (), statement))
    return found


def _unusual(channel: str, size: float, unit: str, *, whole: bool) -> str:
    """Say what is unusual about an effort; empty where nothing is."""
    if whole and size >= FEWEST_COUNTS:
        return (
            f"comes in whole numbers, up to {size:.6g}, as counts of a drive or thousandths of a rated value "
            f"do: declare the unit with the scale of one, if it is not {unit}"
        )
    most = UNITS[channel][unit].usual[1]
    if size <= most:
        return ""
    read = f"read as m{unit} it would be {size / 1e3:.4g} {unit}"
    return f"reaches {size:.4g} {unit}, and seldom exceeds {most:g}; {read}"


def _missing_torques(facts: Facts) -> list[Defect]:
    effort = next(name for name in EFFORTS if name in facts.low)
    dead = np.flatnonzero(facts.span(effort) == 0.0)
    return [
        Defect(
            "missing_torque",
            effort,
            int(joint) + 1,
            facts.samples,
            ((facts.start, facts.start + facts.duration),),
            f"Joint {joint + 1}'s {effort} is {facts.low[effort][joint]:g} "
            f"{facts.units[effort][int(joint)]} throughout, not measured: it is not used.",
        )
        for joint in dead
    ]


def _times(facts: Facts) -> list[Defect]:
    rate = 1.0 / facts.step
    if RATES_HZ[0] <= rate <= RATES_HZ[1]:
        return []
    statement = (
        f"The stamps are {facts.step:.4g} s apart, {rate:.3g} Hz, over {facts.duration:.4g} s, which is "
        "unusual for a robot's log: check the unit of time. Nothing was converted."
    )
    return [Defect("implausible_unit", "time", None, facts.samples, (), statement)]


def _short(facts: Facts) -> list[Defect]:
    if facts.duration >= SHORTEST_SECONDS:
        return []
    statement = (
        f"The log lasts {facts.duration:.3g} s; 10 s or more of varied motion separate parameters better."
    )
    whole = ((facts.start, facts.start + facts.duration),)
    return [Defect("short", "time", None, facts.samples, whole, statement)]
