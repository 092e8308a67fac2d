"""Give the torque of a body attached to a link from an instant on, or in one log: ten columns times a step.

The ten parameters are those of the difference of bodies, in the link's frame; for a removed body they are
negative. A step before the first instant is a body that was there throughout. Source: Khalil & Dombre
(2002), ch. 12.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...arrays import JointSeries
from ...robot.model import INERTIAL_SYMBOLS, INERTIAL_UNITS, RobotModel
from ...signals.state import MotionState
from ..newton_euler import unit_torques
from .effect import AllJointsTerm, without_rounding


@dataclass(frozen=True, eq=False)
class Payload(AllJointsTerm):
    """Model a body fixed to a link (number from 1) from `begin` on, s; its mass may be of either sign."""

    link: int
    begin: float
    symbols = tuple((f"payload_{symbol}", INERTIAL_UNITS[symbol], None) for symbol in INERTIAL_SYMBOLS)
    kind = "payload_change"
    loads = True

    @property
    def changes(self) -> tuple[str, ...]:
        """Name the parameters to which a body that was there throughout adds."""
        whole = self.begin == -np.inf
        return tuple(f"{symbol}{self.link}" for symbol in INERTIAL_SYMBOLS) if whole else ()

    def torques(self, robot: RobotModel, state: MotionState) -> list[JointSeries]:
        """Give the torque per unit of the body's ten parameters while it is there."""
        columns = body_torques(robot, self.link, state)
        if state.time is None:
            return list(columns)
        return list(columns * (state.time >= self.begin)[:, None])


@dataclass(frozen=True, eq=False)
class PayloadOfLog(AllJointsTerm):
    """Model a body fixed to a link (number from 1) in one of several logs (from 0), of either sign."""

    link: int
    log: int
    symbols = Payload.symbols
    kind = Payload.kind
    loads = True

    def torques(self, robot: RobotModel, state: MotionState) -> list[JointSeries]:
        """Give the torque per unit of the body's ten parameters; none outside of its log."""
        return list(body_torques(robot, self.link, state) * state.in_log(self.log)[:, None])


@lru_cache(maxsize=8)
def body_torques(robot: RobotModel, link: int, state: MotionState) -> np.ndarray:
    """Give the torque per unit of each of a link's ten parameters: parameters x samples x joints.

    Cached for the last few stretches, because a scan of the instant uses the same ones.
    """
    torques = np.array(without_rounding(list(unit_torques(robot, link, state))))
    torques.setflags(write=False)
    return torques
