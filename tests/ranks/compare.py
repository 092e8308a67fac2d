"""Compare one drawn robot: the URDF as written by our reader, as meant by the other engine."""

from dataclasses import dataclass

from tests.ranks.drawn import STYLES, drawn_robot
from tests.ranks.engine import Rank, rank_of
from veritorque.core.dynamics.model import standard_model
from veritorque.core.reduction.base import base_model
from veritorque.core.robot.urdf.read import robot_from_urdf


@dataclass(frozen=True)
class Comparison:
    """Hold both numbers."""

    seed: int
    style: str
    ours: int
    least_share: float
    engine: Rank

    @property
    def is_equal(self) -> bool:
        """Tell whether the numbers are equal; with a singular value at the tolerance either is right."""
        return self.engine.least <= self.ours <= self.engine.most


def compare(seed: int) -> Comparison:
    """Draw a robot and count its base parameters both ways."""
    written, meant = drawn_robot(seed)
    base = base_model(standard_model(robot_from_urdf(written)))
    style = STYLES[seed % len(STYLES)]
    return Comparison(seed, style, len(base.kept), base.least_share, rank_of(meant, seed))
