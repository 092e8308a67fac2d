"""Hide effects of time: a torque channel that lags or is filtered, stamps that scatter, rows that repeat."""

from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np
from scipy import signal

from tests.plant.controller import Steering
from tests.plant.effects.effect import Effect, Signals
from tests.plant.mechanism import STEPS_PER_SECOND
from tests.plant.robots import Arm

LOWEST_CUTOFF = 2.0
"""Hz, the least cut-off of a position filter: people filter above the motion."""
FILTERED_STEP = 1e-9
"""rad, the step of an angle that was computed."""
HIGHEST_CUTOFF = 0.45
"""Share of the log's rate above which a filter is none."""


def all_joints(arm: Arm) -> tuple[int, ...]:
    """List all joints, counted from 1."""
    return tuple(range(1, arm.joints + 1))


@dataclass(frozen=True)
class TimeDelay(Effect):
    """Log on all channels the torque of `delay` seconds ago (positive: the torque lags the position)."""

    delay: float
    cause = "time_delay"
    draw_order = 17
    parameters = ("delay",)
    units: ClassVar = {"delay": "s"}
    sizes = ("delay",)
    largest = 0.03
    local = False

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Draw a lag or, more rarely, a lead."""
        return cls(all_joints(arm), 0.003 * float(rng.choice([-1.0, 1.0, 1.0])))

    def sense(self, signals: Signals, rng: np.random.Generator) -> Signals:
        """Shift the torque, interpolating between the simulation's steps."""
        fine = signals.fine_time
        shifted = np.column_stack(
            [np.interp(fine - self.delay, fine, column) for column in signals.fine_torque.T]
        )
        return signals.with_torque(shifted)


@dataclass(frozen=True)
class TorqueFilterLag(Effect):
    """Log on all channels the torque after a first-order low-pass of `time_constant` seconds."""

    time_constant: float
    cause = "torque_filter_lag"
    draw_order = 18
    parameters = ("time_constant",)
    units: ClassVar = {"time_constant": "s"}
    sizes = ("time_constant",)
    largest = 0.05
    local = False

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Start from a few milliseconds."""
        return cls(all_joints(arm), 0.004)

    def sense(self, signals: Signals, rng: np.random.Generator) -> Signals:
        """Filter at the simulation's rate what runs straight between its steps, from a settled start."""
        if self.time_constant <= 0.0:
            return signals
        filtering = ([1.0], [self.time_constant, 1.0])
        ahead, back, _ = signal.cont2discrete(filtering, 1.0 / STEPS_PER_SECOND, method="foh")
        start = signal.lfilter_zi(ahead[0], back)[:, None] * signals.fine_torque[:1]
        slow, _ = signal.lfilter(ahead[0], back, signals.fine_torque, axis=0, zi=start)
        return signals.with_torque(slow)


@dataclass(frozen=True)
class PositionFilter(Effect):
    """Log all positions after a zero-phase low-pass that halves amplitudes at `cutoff` Hz."""

    cutoff: float
    order: int = 2
    cause = "position_filter"
    draw_order = 30
    parameters = ("cutoff",)
    units: ClassVar = {"cutoff": "Hz"}
    sizes = ("cutoff",)
    local = False

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Start from a few times the motion's band, and draw the order."""
        return cls(all_joints(arm), 20.0, int(rng.choice([1, 2])))

    def scaled(self, factor: float) -> Self:
        """Give a filter that takes more: what it takes grows with a power of the time constant."""
        power = -0.5 / self.order
        return replace(self, cutoff=self.cutoff * factor**power if factor > 0.0 else np.inf)

    def plausible(self) -> bool:
        """Leave some motion."""
        return self.cutoff > LOWEST_CUTOFF

    def sense(self, signals: Signals, rng: np.random.Generator) -> Signals:
        """Run a Butterworth filter forwards and backwards over the counted angles and their derivatives."""
        rate = 1.0 / (signals.time[1] - signals.time[0])
        if self.cutoff >= HIGHEST_CUTOFF * rate:
            return signals
        sections = signal.butter(self.order, self.cutoff, fs=rate, output="sos")
        counted = signals.encoder_step * np.round(signals.position / signals.encoder_step)
        parts = (counted, signals.velocity, signals.acceleration)
        position, velocity, acceleration = (signal.sosfiltfilt(sections, part, axis=0) for part in parts)
        return replace(
            signals,
            position=position,
            velocity=velocity,
            acceleration=acceleration,
            encoder_step=np.full_like(signals.encoder_step, FILTERED_STEP),
        )


@dataclass(frozen=True)
class TimestampJitter(Effect):
    """Sample all channels at instants that scatter by `std` seconds about their even stamps."""

    std: float
    cause = "timestamp_jitter"
    draw_order = 19
    parameters = ("std",)
    units: ClassVar = {"std": "s"}
    sizes = ("std",)
    largest = 0.002
    local = False
    raw = True
    last = True

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Start from a tenth of a millisecond."""
        return cls(all_joints(arm), 1e-4)

    def sense(self, signals: Signals, rng: np.random.Generator) -> Signals:
        """Read position and torque where the instants really were."""
        late = self.std * rng.normal(size=(len(signals.time), 1))
        position = signals.position + late * signals.velocity + 0.5 * late**2 * signals.acceleration
        slope = np.gradient(signals.torque, signals.time, axis=0)
        return replace(signals, position=position, torque=signals.torque + late * slope)


@dataclass(frozen=True)
class DroppedSamples(Effect):
    """Repeat the row before in place of a `fraction` of the rows.

    A handful of rows is as strong as the noise, so that their count is too coarse for any wanted strength.
    """

    fraction: float
    cause = "dropped_samples"
    draw_order = 20
    parameters = ("fraction",)
    units: ClassVar = {"fraction": "1"}
    sizes = ("fraction",)
    largest = 0.4
    tolerance = 0.5
    local = False
    raw = True

    @classmethod
    def draw(cls, rng: np.random.Generator, arm: Arm, steering: Steering) -> Self:
        """Start from one row in fifty."""
        return cls(all_joints(arm), 0.02)

    def sense(self, signals: Signals, rng: np.random.Generator) -> Signals:
        """Mark the rows that repeat; the recorder repeats them, noise and all."""
        lost = rng.random(len(signals.time)) < self.fraction
        lost[0] = False
        return replace(signals, kept=np.maximum.accumulate(np.where(lost, 0, np.arange(len(lost)))))
