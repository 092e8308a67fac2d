"""Find numbers that are unlikely in their declared unit, and channels that measure nothing.

Nothing is converted here: numbers of the size of degrees are reported as such, and the user decides.
"""

import numpy as np

from ..model import Defect
from .stretch import Facts

LARGEST_SPAN = 13.0
"""A revolute joint that moves from minus one turn to plus one spans 12.6 rad."""
LARGEST_TORQUE = 2e4
RATES_HZ = (2.0, 1e5)
SHORTEST_SECONDS = 10.0


def plausibility_defects(facts: Facts) -> list[Defect]:
    """State what the extremes, the rate and the length of the log show."""
    return [*_positions(facts), *_torques(facts), *_missing_torques(facts), *_times(facts), *_short(facts)]


def _positions(facts: Facts) -> list[Defect]:
    found = []
    for joint, span in enumerate(facts.span("position")):
        if span > LARGEST_SPAN:
            statement = (
                f"Joint {joint + 1} spans {span:.4g} rad, which is {span / (2 * np.pi):.3g} revolutions; "
                f"read as degrees it would be {np.deg2rad(span):.3g} rad. Nothing was converted."
            )
            found.append(Defect("implausible_unit", "position", joint + 1, facts.samples, (), statement))
    return found


def _torques(facts: Facts) -> list[Defect]:
    found = []
    if "torque" in facts.low:
        largest = np.maximum(np.abs(facts.low["torque"]), np.abs(facts.high["torque"]))
        for joint in np.flatnonzero(largest > LARGEST_TORQUE):
            statement = (
                f"Joint {joint + 1}'s torque reaches {largest[joint]:.4g} N m, more than arms have; read as "
                f"mN m it would be {largest[joint] / 1e3:.4g} N m. Nothing was converted."
            )
            found.append(Defect("implausible_unit", "torque", int(joint) + 1, facts.samples, (), statement))
    return found


def _missing_torques(facts: Facts) -> list[Defect]:
    if "torque" not in facts.low:
        return []
    dead = np.flatnonzero(facts.span("torque") == 0.0)
    return [
        Defect(
            "missing_torque",
            "torque",
            int(joint) + 1,
            facts.samples,
            ((facts.start, facts.start + facts.duration),),
            f"Joint {joint + 1}'s torque is {facts.low['torque'][joint]:g} "
            f"{facts.units['torque'][int(joint)]} throughout, not measured.",
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
