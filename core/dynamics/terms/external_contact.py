"""Give the torque of external contacts of a link: minus J(q)' times a wrench.

Every contact has its own wrench, constant in the base's axes, that rises and falls as a half sine. Its force
acts at the origin of the link's frame, its moment represents the lever of the point of contact. A force that
supports the drives reduces their torque. Source: De Luca & Mattone, ICRA 2005; Khalil & Dombre (2002), ch. 5.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...arrays import Jacobian, JointSeries, Samples
from ...robot.model import RobotModel
from ...signals.state import MotionState
from ..jacobian import jacobian
from .effect import AllJointsTerm, Symbol, without_rounding

Span = tuple[float, float]
"""Start and end of a contact, s."""
WRENCH = (*((f"force_{axis}", "N") for axis in "xyz"), *((f"moment_{axis}", "N m") for axis in "xyz"))


@dataclass(frozen=True, eq=False)
class Contact(AllJointsTerm):
    """Model contacts of a link (number from 1) over spans of time."""

    link: int
    spans: tuple[Span, ...]
    kind = "external_contact"
    loads = True

    @property
    def symbols(self) -> tuple[Symbol, ...]:  # type: ignore[override]  # one wrench per span
        """Name the peaks of every contact's wrench."""
        return tuple(
            (f"{name}_{number}_", unit, None)
            for number in range(1, len(self.spans) + 1)
            for name, unit in WRENCH
        )

    def torques(self, robot: RobotModel, state: MotionState) -> list[JointSeries]:
        """Give the torque per unit of every contact's peak wrench, N and N m."""
        time = np.zeros(len(state.position)) if state.time is None else state.time
        heights = [half_sine(time, span)[:, None] for span in self.spans]
        if not any(height.any() for height in heights):
            return [np.zeros(state.position.shape) for _ in self.symbols]
        push = contact_jacobian(robot, self.link, state)
        return [-height * push[:, axis] for height in heights for axis in range(len(WRENCH))]


def half_sine(time: Samples, span: Span | tuple[Samples, ...]) -> Samples:
    """Give a half sine of height one within a span; or each sample within its own span.

    Examples
    --------
    >>> half_sine(np.array([0.0, 1.0, 2.0, 3.0, 4.0]), (1.0, 3.0)).round(12)
    array([0., 0., 1., 0., 0.])
    """
    start, end = span
    inside = (time > start) & (time < end)
    return np.where(inside, np.sin(np.pi * (time - start) / np.maximum(end - start, 1e-9)), 0.0)


@lru_cache(maxsize=16)
def contact_jacobian(robot: RobotModel, link: int, state: MotionState) -> Jacobian:
    """Give the Jacobian along a stretch; cached, because many spans are tried on the same one."""
    rows = np.moveaxis(jacobian(robot, link, state.position), 1, 0)
    found = np.stack(without_rounding(list(rows)), axis=1)
    found.setflags(write=False)
    return found
