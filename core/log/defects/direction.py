"""Find joints that move one way only: Coulomb friction and torque offset of these are not distinguished.

The way is counted between instants a tenth of a second apart, so that noise averages out.
"""

import numpy as np

from ...arrays import JointVector
from ..model import Defect
from .rest import BLOCK_SECONDS
from .stretch import Facts, Stretch

LEAST_SHARE = 0.02
"""A joint whose way back is a smaller share of its way than this moves one way only."""


class Direction:
    """Sum up every joint's way in the positive and in the negative direction."""

    def __init__(self, joints: int) -> None:
        self._block = 0
        self._up = np.zeros(joints)
        self._down = np.zeros(joints)

    def update(self, stretch: Stretch) -> None:
        """Take the next stretch into account."""
        time, position = stretch.time[stretch.first_new :], stretch.position[:, stretch.first_new :]
        self._block = self._block or max(round(BLOCK_SECONDS / float(np.median(np.diff(time)))), 1)
        ways = np.diff(position[:, :: self._block], axis=1)
        self._up += np.maximum(ways, 0.0).sum(axis=1)
        self._down += np.maximum(-ways, 0.0).sum(axis=1)

    def defects(self, facts: Facts) -> list[Defect]:
        """State the joints that never return."""
        less: JointVector = np.minimum(self._up, self._down)
        more: JointVector = np.maximum(self._up, self._down)
        found = []
        for joint in map(int, np.flatnonzero(less < LEAST_SHARE * more)):
            if facts.travels(joint):
                unit, number = facts.units["position"][joint], joint + 1
                statement = (
                    f"Joint {number} moves one way only: {self._up[joint]:.3g} {unit} up and "
                    f"{self._down[joint]:.3g} {unit} down. Its Coulomb friction FC{number} and its torque "
                    f"offset OFF{number} are then one number, and what is said of each alone is not known. A "
                    "motion that covers the same range in both directions distinguishes them."
                )
                found.append(Defect("one_direction", "position", number, facts.samples, (), statement))
        return found
