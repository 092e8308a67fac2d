"""Find joints whose positions are the same to the last digit: one column stands for both.

No two encoders read the same. References may be alike, and then two motors move alike as well.
"""

from itertools import combinations

from ..model import Defect
from .stretch import Facts, Stretch


class Shared:
    """Compare the positions of every two joints, sample by sample."""

    def __init__(self, joints: int) -> None:
        self._alike = list(combinations(range(joints), 2))

    def update(self, stretch: Stretch) -> None:
        """Take the next stretch into account."""
        position = stretch.position
        self._alike = [
            (first, second)
            for first, second in self._alike
            if position[first, -1] == position[second, -1] and (position[first] == position[second]).all()
        ]

    def defects(self, facts: Facts) -> list[Defect]:
        """State which joints that move share their positions."""
        return [
            Defect(
                "shared_position",
                "position",
                second + 1,
                facts.samples,
                (),
                f"Joints {first + 1} and {second + 1} have the same positions in every sample, to the last "
                "digit: one column stands for both, or these are references. Map the measured positions.",
            )
            for first, second in self._alike
            if facts.travels(first)
        ]
