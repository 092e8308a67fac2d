"""Give the effect of joint elasticity with motor-side encoders: the link lags by torque over stiffness.

The link's position is q - x. To first order in x, the link moves by M x'' + (D + C) x' + (K + G) x = load:
M, C and G are the load's derivatives by the joint's acceleration, velocity and position along the motion, so
that the resonance moves with the posture. The change of the load is linear in 1 / K where K is what the
resonance yields.
Source: Spong, J. Dyn. Sys. Meas. Control 109, 1987.
"""

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from ...arrays import JointSeries, Samples
from ...numerics.oscillator import swing
from ...robot.joint_units import joint_unit
from ...robot.model import Parameter, RobotModel
from ...signals.state import MotionState
from ...signals.zero_phase import kernel
from ..gear import Gear
from ..prediction import Prediction
from .effect import AllJointsTerm, step_of

LEAST_INERTIA = 0.05
"""Share of the mean moved inertia below which none is taken: a fit may give a posture one of any sign."""
MOST_SWING = 1e6
"""Times what a link moves that follows its pull at once; set by hand, far above any resonance."""
LEAST_STIFFNESS = 0.2
"""Share of the spring's stiffness that the load's slope by position leaves of it at least."""


@dataclass(frozen=True, eq=False)
class Elasticity(AllJointsTerm):
    """Model joint elasticity."""

    believed: Prediction
    band_hz: float
    """Bandwidth at which loads are smoothed before differentiation."""
    resonance_hz: float
    damping_ratio: float
    """Those of the link's mean inertia on the spring: far below it the link follows the load without lag."""
    motor_inertia: float = 0.0
    """Rotor inertia that the operating point's load contains, kg m2 (kg)."""
    symbols = (("compliance", "rad/(N m)", 0.0),)
    kind = "joint_elasticity"
    has_memory = True

    def parameters(self, robot: RobotModel) -> tuple[Parameter, ...]:
        """List the compliance, in the unit of its joint."""
        return tuple(
            replace(compliance, unit=joint_unit(robot, self.joint, compliance.unit))
            for compliance in super().parameters(robot)
        )

    def torques(self, robot: RobotModel, state: MotionState) -> list[JointSeries]:
        """Give the change of all joints' loads per unit of compliance."""
        del robot
        gear = Gear(self.believed, self.joint, self.motor_inertia)
        link = _swinging(gear, state, self.band_hz)
        angular = 2.0 * np.pi * self.resonance_hz
        springs = angular**2 / link.inertia
        squares = np.maximum(springs + link.slope, LEAST_STIFFNESS * springs)
        decays = self.damping_ratio * angular / link.inertia + link.decay
        lag = -(angular**2) * _followed(link.pull, step_of(state), squares, decays)
        return [gear.displaced(state, lag)]


@np.errstate(over="ignore", invalid="ignore")
def _followed(pull: Samples, step: float, squares: Samples, decays: Samples) -> Samples:
    """Give how the link swings, or, where that grows without bound, how it would follow its pull at once.

    In a wrong description, or with positions in a wrong unit, the load drives its own swing until no number
    holds it.
    """
    at_once = pull / squares
    swinging = swing(pull, step, squares, decays)
    is_bounded = np.max(np.abs(swinging)) <= MOST_SWING * np.max(np.abs(at_once))  # never where one is NaN
    return swinging if is_bounded else np.asarray(at_once)


@dataclass(frozen=True, eq=False)
class _Link:
    """Hold the link's own motion: inertia over its mean, load, slope and decay over inertia."""

    inertia: Samples
    pull: Samples
    slope: Samples
    decay: Samples


@lru_cache(maxsize=64)
def _swinging(gear: Gear, state: MotionState, band_hz: float) -> _Link:
    """Give how the link behind a transmission swings; cached for a scan."""
    load = smooth(gear.load(state)[:, None], state, band_hz)[:, 0]
    inertia = gear.inertia(state)
    mean = float(np.mean(inertia))
    if mean <= 0.0:  # no spring is found on such a link
        return _Link(np.ones_like(load), load, np.zeros_like(load), np.zeros_like(load))
    moved = np.maximum(inertia, LEAST_INERTIA * mean)
    by_position, by_velocity = gear.slopes(state)
    return _Link(moved / mean, load * mean / moved, by_position / moved, 0.5 * by_velocity / moved)


def smooth(values: JointSeries, state: MotionState, band_hz: float) -> JointSeries:
    """Filter columns by a zero-phase low-pass; beyond its ends a series is continued by its end values."""
    response = kernel(min(band_hz, 0.4 / step_of(state)), 1.0 / step_of(state), 2)
    reach = len(response) // 2
    padded = np.concatenate(
        [np.repeat(values[:1], reach, axis=0), values, np.repeat(values[-1:], reach, axis=0)]
    )
    return np.column_stack([np.convolve(column, response, mode="valid") for column in padded.T])
