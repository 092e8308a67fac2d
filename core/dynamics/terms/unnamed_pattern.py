"""Give patterns without a physical model: what a residual may follow where no known effect explains it.

Products of speeds, waves over another joint's angle, waves in time, an oscillation at its own rate, two
levels, and friction that switches at an instant: a family wide enough to detect lack of fit, and where,
without a physical name. Source: Kennedy & O'Hagan, J. R. Stat. Soc. B 63, 2001, for a discrepancy without a
name.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from itertools import accumulate, repeat

import numpy as np
from scipy.ndimage import uniform_filter1d
from scipy.signal import lfilter

from ...arrays import Samples
from ...numerics.following import follow_with_friction
from ...robot.model import Parameter, RobotModel
from ...signals.state import MotionState
from ..prediction import Prediction
from .effect import OneJointTerm, step_of

HARMONICS = 3
SWING_DAMPING = 0.05
LOOP_DAMPING = 0.7
Numbers = tuple[float, ...]
_COUNTS = {"speeds": 1, "angle": 2, "clock": 2 * HARMONICS, "swing": 2, "levels": 1, "friction": 2, "loop": 1}


@dataclass(frozen=True, eq=False)
class Trace(OneJointTerm):
    """Model one pattern (`PATTERNS`) with its numbers."""

    pattern: str
    """``speeds``: product of the speeds of joints a and b. ``angle``: cosine and sine of h times joint a's
    angle, times a factor of the own speed. ``clock``: a period of 1 / f seconds with its harmonics.
    ``swing``: deflection and rate of an oscillator at f Hz, driven by the own acceleration. ``levels``: plus
    or minus one, with a change of sign at each of the instants, s. ``friction``: own Coulomb and viscous
    friction from an instant on, s."""
    numbers: Numbers
    kind = "unlisted"
    has_memory = True

    def parameters(self, robot: RobotModel) -> tuple[Parameter, ...]:
        """List a number per column."""
        del robot
        return tuple(
            Parameter(f"trace_{index}", self.joint, self.joint, "N m", None)
            for index in range(_COUNTS[self.pattern])
        )

    @property
    def source(self) -> tuple[object, ...]:
        """Name what the columns depend on besides the motion: the joint often does not matter."""
        alike = self.pattern in ("speeds", "clock", "levels")
        alike |= self.pattern == "angle" and FACTORS[int(self.numbers[2])] is np.ones_like
        return self.pattern, self.numbers, 0 if alike else self.joint

    def columns(self, state: MotionState) -> list[Samples]:
        """Give the pattern's columns."""
        return PATTERNS[self.pattern](self.joint - 1, self.numbers, state)


@dataclass(frozen=True, eq=False)
class GainDrift(OneJointTerm):
    """Model a gain of the torque channel that changes with time, steadily or faster at first or at last."""

    believed: Prediction
    centre: float
    """Instant about which it changes, s."""
    seconds: float
    """Seconds over which it changes by the parameters."""
    symbols = (("change", "1", None), ("bend", "1", None))
    kind = "unlisted"

    def columns(self, state: MotionState) -> list[Samples]:
        """Give the joint's predicted torque, times time and times its square."""
        torque = self.believed.applied(state)[:, self.joint - 1]
        time = (_time(state) - self.centre) / self.seconds
        return [torque * time, torque * time**2]


@dataclass(frozen=True, eq=False)
class OtherTorques(OneJointTerm):
    """Model a torque channel that also reads shares of the other joints' torques."""

    believed: Prediction
    kind = "unlisted"

    def parameters(self, robot: RobotModel) -> tuple[Parameter, ...]:
        """List a share per other joint."""
        return tuple(
            Parameter(f"of_{joint}", self.joint, self.joint, "1", None)
            for joint in range(1, len(robot.joints) + 1)
            if joint != self.joint
        )

    def columns(self, state: MotionState) -> list[Samples]:
        """Give the predicted torques of the other joints."""
        return list(np.delete(self.believed.applied(state), self.joint - 1, axis=1).T)


@dataclass(frozen=True, eq=False)
class SmoothedTorque(OneJointTerm):
    """Model a torque that was smoothed alike forwards and backwards: it changes before its cause does."""

    believed: Prediction
    seconds: float
    """Length of the moving mean, s."""
    symbols = (("share", "1", None),)
    kind = "unlisted"
    has_memory = True

    def columns(self, state: MotionState) -> list[Samples]:
        """Give the mean of the joint's predicted torque about every instant, less the torque."""
        torque = self.believed.applied(state)[:, self.joint - 1]
        samples = 1 + 2 * round(0.5 * self.seconds / step_of(state))
        return [uniform_filter1d(torque, samples, mode="nearest") - torque]


def _speeds(own: int, numbers: Numbers, state: MotionState) -> list[Samples]:
    del own
    first, second = (int(joint) - 1 for joint in numbers)
    return [state.velocity[:, first] * state.velocity[:, second]]


FACTORS: tuple[Callable[[Samples], Samples], ...] = (
    np.ones_like,
    np.asarray,
    np.sign,
    lambda v: v * np.abs(v),
)
"""How a wave over another joint's angle may depend on the own speed."""


def _angle(own: int, numbers: Numbers, state: MotionState) -> list[Samples]:
    other, harmonic, factor = int(numbers[0]) - 1, numbers[1], int(numbers[2])
    size = FACTORS[factor](state.velocity[:, own])
    return [size * wave for wave in _waves(other, harmonic, state)]


@lru_cache(maxsize=32)
def _waves(joint: int, harmonic: float, state: MotionState) -> tuple[Samples, Samples]:
    """Give cosine and sine of a multiple of a joint's angle; all joints and factors of a scan share them."""
    angle = harmonic * state.position[:, joint]
    return np.cos(angle), np.sin(angle)


def _clock(own: int, numbers: Numbers, state: MotionState) -> list[Samples]:
    del own
    turns = 2.0 * np.pi * numbers[0] * _time(state)
    waves = accumulate(repeat(np.cos(turns) + 1j * np.sin(turns), HARMONICS), np.multiply)
    return [part for wave in waves for part in (wave.real, wave.imag)]


def _swing(own: int, numbers: Numbers, state: MotionState) -> list[Samples]:
    rate, step = 2.0 * np.pi * numbers[0], step_of(state)
    # Deflections and rates step by step: s' = -2 z w s - w^2 x - a, x' = s, with s known first.
    swings = [
        1.0,
        -2.0 + step * (2.0 * SWING_DAMPING * rate + step * rate**2),
        1.0 - 2.0 * SWING_DAMPING * rate * step,
    ]
    deflection = lfilter([-(step**2)], swings, state.acceleration[:, own])
    return [np.asarray(deflection), np.gradient(deflection, step)]


def _levels(own: int, numbers: Numbers, state: MotionState) -> list[Samples]:
    del own
    changes = np.searchsorted(np.sort(numbers), _time(state))
    return [np.where(changes % 2, -1.0, 1.0)]


def _friction(own: int, numbers: Numbers, state: MotionState) -> list[Samples]:
    after, velocity = _time(state) >= numbers[0], state.velocity[:, own]
    return [np.where(after, np.sign(velocity), 0.0), np.where(after, velocity, 0.0)]


def _loop(own: int, numbers: Numbers, state: MotionState) -> list[Samples]:
    rate_hz, friction, fed = numbers
    velocity, acceleration = state.velocity[:, own], state.acceleration[:, own]
    pulled = np.empty(len(velocity))
    angular = 2.0 * np.pi * rate_hz
    loop = (angular**2, 2.0 * LOOP_DAMPING * angular, friction, fed)
    follow_with_friction(
        np.ascontiguousarray(velocity), np.ascontiguousarray(acceleration), step_of(state), loop, pulled
    )
    return [pulled - np.sign(velocity) - (1.0 - fed) * acceleration / friction]


def _time(state: MotionState) -> Samples:
    return np.arange(len(state.position), dtype=float) if state.time is None else state.time


PATTERNS: Mapping[str, Callable[[int, Numbers, MotionState], list[Samples]]] = {
    "speeds": _speeds,
    "angle": _angle,
    "clock": _clock,
    "swing": _swing,
    "levels": _levels,
    "friction": _friction,
    "loop": _loop,
}
