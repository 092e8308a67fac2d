"""Give the effect of an encoder error: the model's torque at the true angle, minus that at the measured one.

An encoder reads the true angle plus an error; to first order the true angle is the reading minus the error. A
constant error changes gravity and inertia only. An error that varies with the angle also changes velocity and
acceleration, and with them friction and rotor torque. Source: Khalil & Dombre (2002), ch. 11.
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import JointSeries
from ...robot.model import RobotModel
from ...signals.state import MotionState
from ..prediction import Prediction, shift_joint
from .effect import AllJointsTerm

SMALL = 1e-5
"""Size of the finite error, rad: its square and its rounding are negligible."""


@dataclass(frozen=True, eq=False)
class EncoderOffset(AllJointsTerm):
    """Model a reading that is the true angle plus `offset`."""

    believed: Prediction
    symbols = (("offset", "rad", None),)
    kind = "encoder_offset"

    def torques(self, robot: RobotModel, state: MotionState) -> list[JointSeries]:
        """Give minus the change of load per rad."""
        del robot
        return [-self.believed.slopes(state, self.joint - 1)[0]]


@dataclass(frozen=True, eq=False)
class EncoderEccentricity(AllJointsTerm):
    """Model a reading that is the true angle plus `sine` sin(q) + `cosine` cos(q)."""

    believed: Prediction
    symbols = (("sine", "rad", None), ("cosine", "rad", None))
    kind = "encoder_eccentricity"

    def torques(self, robot: RobotModel, state: MotionState) -> list[JointSeries]:
        """Give minus the change of torque per rad of sin(q), and of cos(q)."""
        del robot
        own = self.joint - 1
        q, dq, ddq = (series[:, [own]] for series in (state.position, state.velocity, state.acceleration))
        sine, cosine = np.sin(q), np.cos(q)
        errors = (
            MotionState(sine, cosine * dq, cosine * ddq - sine * dq**2),
            MotionState(cosine, -sine * dq, -sine * ddq - cosine * dq**2),
        )
        return _changes(self.believed, state, own, errors)


@dataclass(frozen=True, eq=False)
class PositionScale(AllJointsTerm):
    """Model a reading that is the true position times 1 + `scale`."""

    believed: Prediction
    symbols = (("scale", "1", None),)
    kind = "unlisted"

    def torques(self, robot: RobotModel, state: MotionState) -> list[JointSeries]:
        """Give minus the change of torque per share of the position."""
        del robot
        own = self.joint - 1
        error = MotionState(
            *(series[:, [own]] for series in (state.position, state.velocity, state.acceleration))
        )
        return _changes(self.believed, state, own, (error,))


def _changes(
    believed: Prediction, state: MotionState, own: int, errors: tuple[MotionState, ...]
) -> list[JointSeries]:
    """Give minus the change of torque with each error of a joint (from 0), to first order."""
    plain = believed.torque(state)
    out = []
    for error in errors:
        shift = MotionState(
            *(-SMALL * series for series in (error.position, error.velocity, error.acceleration))
        )
        out.append((believed.torque(shift_joint(state, own, shift)) - plain) / SMALL)
    return out
