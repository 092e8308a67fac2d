"""Hide textbook effects in the second world: in its friction, its drives, its encoders or its load.

Each is written from a textbook's formula, not from the columns of the code under test, and acts inside the
loop where the real one does. Sources: Armstrong-Helouvry, Dupont & Canudas de Wit, Automatica 30 (1994), for
friction; Bittencourt & Gunnarsson, J. Dyn. Syst. Meas. Control 134 (2012), for load and temperature; Spong,
Hutchinson & Vidyasagar, Robot Modeling and Control (2006), for drives and loads.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

SHARES = (0.1, 0.6)
"""Lowest and highest size of an effect over the scale it changes, which each effect names."""
Log = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Time (s), positions (rad) and torques (N m) as they are logged."""


@dataclass(frozen=True)
class Change:
    """Change nothing; an effect overrides where it acts.

    `joint` is where it acts, `size` its share of what it changes, `phase` a drawn number in 0..1 and `scale`
    the torque that the joint's weight and friction ask for (N m).
    """

    cause: ClassVar[str] = ""
    local: ClassVar[bool] = True
    first_only: ClassVar[bool] = False
    """Whether no log shows it on the last joint."""
    joint: int
    size: float
    phase: float
    scale: float

    def push(self, _time: float, _angle: np.ndarray, _rate: np.ndarray) -> float:
        """Give the torque on the joint that neither drive nor weight makes, N m."""
        return 0.0

    def level(self, level: float, _time: float, _angle: float, _rate: float, _load: float) -> float:
        """Give the level of the joint's dry friction, N m, where the gear transmits a load, N m."""
        return level

    def body(self, body: Any, _time: float) -> Any:
        """Give the bodies at a time, s."""
        return body

    def seen(self, angle: np.ndarray) -> np.ndarray:
        """Give the angles that the encoders see, rad."""
        return angle

    def logged(self, log: Log) -> Log:
        """Give what is logged."""
        return log

    def on_torque(self, log: Log, law: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> Log:
        """Put a law of time (s) and torque (N m) on the joint's logged torque."""
        time, position, torque = log
        torque = torque.copy()
        torque[:, self.joint] = law(time, torque[:, self.joint])
        return time, position, torque


class Stribeck(Change):
    """Raise friction by up to 1.5 times near standstill, Armstrong's form."""

    cause = "friction_stribeck"

    def level(self, level: float, _time: float, _angle: float, rate: float, _load: float) -> float:
        """Let the level fall from its peak with the square of the speed."""
        slow = 0.05 + 0.1 * self.phase
        return level * (1.0 + 2.5 * self.size * np.exp(-((rate / slow) ** 2)))


class LoadFriction(Change):
    """Let friction grow with the torque that the gear transmits."""

    cause = "friction_load_dependent"

    def level(self, level: float, _time: float, _angle: float, _rate: float, load: float) -> float:
        """Add a share of the load."""
        return level + 0.5 * self.size * abs(load)


class Warming(Change):
    """Let dry friction fall as the gear warms."""

    cause = "friction_temperature"

    def level(self, level: float, time: float, _angle: float, _rate: float, _load: float) -> float:
        """Fall with a time constant of 6 to 14 s."""
        return level * (1.0 + 1.5 * self.size * np.exp(-time / (6.0 + 8.0 * self.phase)))


class UnevenFriction(Change):
    """Let dry friction change over a turn."""

    cause = "friction_position_dependent"

    def level(self, level: float, _time: float, angle: float, _rate: float, _load: float) -> float:
        """Change with the angle, two or three times a turn."""
        return level * (1.0 + self.size * np.sin((2 + round(self.phase)) * angle + 6.0 * self.phase))


class OneSidedDrag(Change):
    """Let drag be larger in one direction. Dry friction that is would be an offset of the torque."""

    cause = "friction_asymmetric"

    def push(self, _time: float, _angle: np.ndarray, rate: np.ndarray) -> float:
        """Brake forwards, and help backwards."""
        return -0.1 * self.size * self.scale * abs(float(rate[self.joint]))


class BentViscous(Change):
    """Let drag grow with the square of the speed."""

    cause = "friction_viscous_nonlinear"

    def push(self, _time: float, _angle: np.ndarray, rate: np.ndarray) -> float:
        """Brake by the square."""
        own = float(rate[self.joint])
        return -0.3 * self.size * self.scale * abs(own) * own


class Ripple(Change):
    """Let the drive's torque ripple over a turn."""

    cause = "torque_ripple"

    def push(self, _time: float, angle: np.ndarray, _rate: np.ndarray) -> float:
        """Ripple 6 to 18 times a turn."""
        often = 6 * (1 + round(2.0 * self.phase))
        return 0.2 * self.size * self.scale * float(np.sin(often * angle[self.joint] + 6.0 * self.phase))


class Spring(Change):
    """Balance the joint by a linear spring."""

    cause = "spring_compensator"

    def push(self, _time: float, angle: np.ndarray, _rate: np.ndarray) -> float:
        """Pull towards an angle."""
        return -self.size * self.scale * (float(angle[self.joint]) - 2.0 * self.phase + 1.0)


class Contact(Change):
    """Push the joint for one to two seconds, once."""

    cause = "external_contact"
    local = False

    def push(self, time: float, _angle: np.ndarray, _rate: np.ndarray) -> float:
        """Push smoothly."""
        begin, width = 8.0 + 12.0 * self.phase, 1.0 + self.phase
        inside = (time - begin) / width
        return self.size * self.scale * float(np.sin(np.pi * inside)) if 0.0 < inside < 1.0 else 0.0


class Payload(Change):
    """Let the tip take up a body after a while."""

    cause = "payload_change"
    local = False

    def body(self, body: Any, time: float) -> Any:
        """Add a point mass at 0.3 m on the second link."""
        if time < 10.0 + 10.0 * self.phase:
            return body
        mass, out, link = 4.0 * self.size, 0.3, 0.5
        return replace(
            body,
            first=body.first + mass * link**2,
            second=body.second + mass * out**2,
            coupling=body.coupling + mass * link * out,
            weights=body.weights + 9.81 * mass * np.array([link, out]),
        )


class Eccentric(Change):
    """Let the encoder's disc sit off its axis by up to 15 mrad."""

    cause = "encoder_eccentricity"

    def seen(self, angle: np.ndarray) -> np.ndarray:
        """Add a sine of one turn."""
        seen = angle.copy()
        seen[self.joint] += 0.025 * self.size * np.sin(angle[self.joint] + 6.0 * self.phase)
        return seen


class Offset(Change):
    """Let the encoder's zero be off by up to 0.15 rad. The last joint's would turn its body alike."""

    cause = "encoder_offset"
    first_only = True

    def seen(self, angle: np.ndarray) -> np.ndarray:
        """Shift the zero."""
        seen = angle.copy()
        seen[self.joint] += (0.25 if self.phase > 0.5 else -0.25) * self.size
        return seen


class Gain(Change):
    """Log the torque by a wrong constant."""

    cause = "torque_gain"

    def logged(self, log: Log) -> Log:
        """Scale the torque."""
        return self.on_torque(log, lambda _, torque: torque * (1.0 + self.size))


class Saturating(Change):
    """Log what a saturating motor does not make: the current's torque above the true one."""

    cause = "torque_gain_nonlinear"

    def logged(self, log: Log) -> Log:
        """Add a cubic share that reaches `size` at the highest torque."""
        return self.on_torque(
            log, lambda _, torque: torque * (1.0 + self.size * (torque / np.abs(torque).max()) ** 2)
        )


class Drift(Change):
    """Let the sensor's zero drift over the log."""

    cause = "torque_offset_drift"

    def logged(self, log: Log) -> Log:
        """Drift as a cooling body does."""
        slow = 10.0 + 30.0 * self.phase
        return self.on_torque(
            log, lambda time, torque: torque + self.size * torque.std() * (1.0 - np.exp(-time / slow))
        )


class Clipped(Change):
    """Clip the logged torque."""

    cause = "torque_saturation"

    def logged(self, log: Log) -> Log:
        """Clip at a level that a few rows pass."""

        def law(_: np.ndarray, torque: np.ndarray) -> np.ndarray:
            most = np.quantile(np.abs(torque), 0.98 - 0.15 * self.size)
            return np.clip(torque, -most, most)

        return self.on_torque(log, law)


class DeadZone(Change):
    """Log small torques as zero."""

    cause = "torque_dead_zone"

    def logged(self, log: Log) -> Log:
        """Cut what is below a share of the RMS."""
        return self.on_torque(
            log,
            lambda _, torque: (
                np.sign(torque) * np.maximum(np.abs(torque) - 0.4 * self.size * torque.std(), 0.0)
            ),
        )


class Late(Change):
    """Log all torques late by 3 to 12 ms."""

    cause = "time_delay"
    local = False

    def logged(self, log: Log) -> Log:
        """Take an earlier torque."""
        time, position, torque = log
        late = time - 0.02 * self.size
        return time, position, np.stack([np.interp(late, time, own) for own in torque.T], axis=1)


class Lag(Change):
    """Pass the logged torques through a filter of first order, 4 to 18 ms."""

    cause = "torque_filter_lag"
    local = False

    def logged(self, log: Log) -> Log:
        """Filter exactly between rows, the torque taken for a line there."""
        time, position, torque = log
        slow, step = 0.03 * self.size, float(time[1] - time[0])
        keep = np.exp(-step / slow)
        behind = torque.copy()
        for row in range(1, len(torque)):
            slope = (torque[row] - torque[row - 1]) / step
            steady = torque[row] - slope * slow
            behind[row] = steady + keep * (behind[row - 1] - torque[row - 1] + slope * slow)
        return time, position, behind


ALL: tuple[type[Change], ...] = (
    Stribeck,
    LoadFriction,
    Warming,
    UnevenFriction,
    OneSidedDrag,
    BentViscous,
    Ripple,
    Spring,
    Contact,
    Payload,
    Eccentric,
    Offset,
    Gain,
    Saturating,
    Drift,
    Clipped,
    DeadZone,
    Late,
    Lag,
)


def draw_changes(rng: np.random.Generator, scales: np.ndarray) -> tuple[Change, ...]:
    """Draw one effect, or in one log of three two, given the torque that each joint asks for (N m)."""
    kinds = rng.permutation(len(ALL))[: 1 + (rng.random() < 1.0 / 3.0)]
    drawn = []
    for kind in kinds:
        joint = 0 if ALL[kind].first_only else int(rng.integers(len(scales)))
        size = float(np.exp(rng.uniform(*np.log(SHARES))))
        drawn.append(ALL[kind](joint, size, float(rng.random()), float(scales[joint])))
    return tuple(drawn)
