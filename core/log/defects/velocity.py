"""Compare the velocity that the recorder gives with the way that the positions cover by their stamps.

Over a tenth of a second the integral of the velocity is the way, whatever the noise of either. A factor that
all joints share is the clock's, or a unit's; one that a joint has alone is its own.
"""

import numpy as np

from ..model import Defect
from .rest import BLOCK_SECONDS
from .stretch import Facts, Stretch

TOLERANCE = 0.1
"""A factor that differs from 1 by less is a filter's or a controller's lag."""
FOLLOWS = 0.95
"""Above this correlation the velocity is the positions', but for a factor."""
ALIKE = 0.03
"""Factors of joints that differ by less than this share are one."""
KNOWN = {180.0 / np.pi: "deg/s for rad/s", 30.0 / np.pi: "rpm for rad/s", 1000.0: "thousandths"}


class Velocity:
    """Sum up products of ways and integrals of velocities."""

    def __init__(self, joints: int) -> None:
        self._block = 0
        self._ways = np.zeros(joints)
        self._integrals = np.zeros(joints)
        self._products = np.zeros(joints)

    def update(self, stretch: Stretch) -> None:
        """Take the next stretch into account."""
        velocity = stretch.channels.get("velocity")
        if velocity is None:
            return
        time = stretch.time
        steps = np.diff(time)
        self._block = self._block or max(round(BLOCK_SECONDS / float(np.median(steps))), 1)
        covered = np.cumsum(0.5 * (velocity[:, 1:] + velocity[:, :-1]) * steps, axis=1)
        integrals = np.diff(covered[:, :: self._block], axis=1)
        ways = np.diff(stretch.position[:, 1 :: self._block], axis=1)
        prompt = np.diff(time[1 :: self._block]) < 2.0 * self._block * np.median(steps)
        self._ways += np.sum(prompt * ways**2, axis=1)
        self._integrals += np.sum(prompt * integrals**2, axis=1)
        self._products += np.sum(prompt * ways * integrals, axis=1)

    def _moving(self, facts: Facts) -> list[int]:
        """List the joints (from 0) that travel, by their positions and by their velocities."""
        both = self._ways * self._integrals
        return [joint for joint, size in enumerate(both) if size and facts.travels(joint)]

    def defects(self, facts: Facts) -> list[Defect]:
        """State where velocity and positions contradict each other."""
        if "velocity" not in facts.low:
            return []
        moving = self._moving(facts)
        if not moving:
            return []
        factors = self._products[moving] / self._ways[moving]
        together = self._products[moving] / np.sqrt(self._ways[moving] * self._integrals[moving])
        follows = np.abs(together) > FOLLOWS
        shared = float(np.median(factors))
        if len(moving) > 1 and np.all(follows & (np.abs(factors - shared) < ALIKE * abs(shared))):
            return [_shared(shared, facts)] if _is_off(shared) else []
        return [
            _own(joint, float(factor), float(r), facts)
            for joint, factor, r in zip(moving, factors, together, strict=True)
            if abs(r) <= FOLLOWS or _is_off(float(factor))
        ]


def _is_off(factor: float) -> bool:
    return abs(factor - 1.0) > TOLERANCE


def _shared(factor: float, facts: Facts) -> Defect:
    statement = (
        f"The measured velocity is {factor:.4g} times what positions and stamps give, on every joint that "
        f"moves{_meaning(factor)}. Either the stamps are {_slower(factor)}, or the velocity is in another "
        "unit."
    )
    return Defect("velocity_mismatch", "time", None, facts.samples, (), statement)


def _own(joint: int, factor: float, together: float, facts: Facts) -> Defect:
    if abs(together) <= FOLLOWS:
        what = f"does not follow its positions (correlation {together:.2f}): it may be another joint's"
    else:
        what = f"is {factor:.4g} times what positions and stamps give{_meaning(factor)}"
    statement = f"Joint {joint + 1}'s measured velocity {what}. Check the columns, their units and the clock."
    return Defect("velocity_mismatch", "velocity", joint + 1, facts.samples, (), statement)


def _slower(factor: float) -> str:
    if factor < 0.0:
        return "those of a motion run backwards"
    return f"{factor:.4g} times too far apart" if factor > 1.0 else f"{1.0 / factor:.4g} times too close"


def _meaning(factor: float) -> str:
    """Say what a factor is known for."""
    for known, meaning in KNOWN.items():
        if abs(factor / known - 1.0) < ALIKE:
            return f", as {meaning} would be"
    return ", with the opposite sign" if factor < 0.0 else ""
