"""Find positions that equal the controller's reference to the last digit: they were not measured.

No joint follows its reference exactly, and no encoder reads it without an error.
"""

import numpy as np

from ...arrays import JointMarks
from ..model import Defect
from .stretch import Facts, Stretch


class Reference:
    """Compare positions and reference, sample by sample."""

    def __init__(self, joints: int) -> None:
        self._same: JointMarks = np.ones(joints, dtype=bool)
        self._logged = False

    def update(self, stretch: Stretch) -> None:
        """Take the next stretch into account."""
        reference = stretch.channels.get("position_ref")
        if reference is not None:
            self._logged = True
            self._same &= np.all(reference == stretch.position, axis=1)

    def defects(self, facts: Facts) -> list[Defect]:
        """State whether the positions of all joints that move are the reference."""
        moving = [joint for joint in range(len(self._same)) if facts.travels(joint)]
        if not (self._logged and moving and self._same[moving].all()):
            return []
        statement = (
            "The positions equal their reference (position_ref) in every sample, to the last digit, on "
            f"{'the joint' if len(moving) == 1 else f'all {len(moving)} joints'} that move. They were not "
            "measured: the torque is that of a motion which lags behind. Map the measured positions."
        )
        return [Defect("position_is_reference", "position", None, facts.samples, (), statement)]
