"""Measure the position error of a robot that is simulated under the measured torque.

Torque residuals say how wrong a model is at an instant; what a user of a simulation sees is motion that
drifts away. From measured states, every so often, the model is simulated over a short window and compared at
several horizons; a robot without any model, which keeps its velocity, stands beside it as the scale. Errors
of the torque channel, and torques that depend on the past, are subtracted from the input.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..arrays import BlockKey, JointVector, Matrix
from ..errors import OptionError
from ..signals.condition import Motion
from .along import driving_torque
from .drive import Drive
from .integrate import LONGEST_STEP
from .mechanism import Mechanism
from .rollout import rollout
from .stage import States
from .windows import Windows, windows

Progress = Callable[[float], None]
_AT_ONCE = 1024


@dataclass(frozen=True)
class MultiStepOptions:
    """Choose horizons and how often a window starts, s; windows start at decimated samples only."""

    horizons: tuple[float, ...] = (0.05, 0.1, 0.2)
    every: float = 0.1
    longest_step: float = LONGEST_STEP

    def __post_init__(self) -> None:
        """Refuse horizons that are none."""
        rising = all(early < late for early, late in zip(self.horizons, self.horizons[1:], strict=False))
        good = self.horizons and self.horizons[0] > 0.0 and rising and self.horizons[-1] <= 10.0
        if not good or self.every <= 0.0 or not 1e-6 <= self.longest_step <= 0.1:
            raise OptionError(
                "the horizons are not valid",
                evidence={
                    "horizons": list(self.horizons),
                    "every": self.every,
                    "longest_step": self.longest_step,
                },
                remedy="give rising horizons up to 10 s, a positive interval, and a step from 1e-6 to 0.1 s",
            )


@dataclass(frozen=True, eq=False)
class MultiStep:
    """Hold predicted minus measured motion of every window, (windows, horizons, joints)."""

    horizons: tuple[float, ...]
    keys: tuple[BlockKey, ...]
    begins: np.ndarray
    """Log and block, and start in s, of every window."""
    position: np.ndarray
    velocity: np.ndarray
    """Errors in rad (m) and per s."""
    still: np.ndarray
    """The error in position of keeping the first velocity: what no model at all would give."""

    @property
    def position_rms(self) -> Matrix:
        """Give the RMS error in position per horizon and joint, rad or m."""
        return _rms(self.position)

    @property
    def velocity_rms(self) -> Matrix:
        """Give the RMS error in velocity per horizon and joint, per s."""
        return _rms(self.velocity)

    @property
    def still_rms(self) -> Matrix:
        """Give the RMS error in position of keeping the velocity, per horizon and joint."""
        return _rms(self.still)

    def within(self, chosen: frozenset[BlockKey]) -> "MultiStep":
        """Keep the windows of some blocks, such as those held out."""
        rows = np.array([key in chosen for key in self.keys], dtype=bool)
        keys = tuple(key for key in self.keys if key in chosen)
        return MultiStep(
            self.horizons, keys, self.begins[rows], self.position[rows], self.velocity[rows], self.still[rows]
        )


def predict_motion(
    mechanism: Mechanism,
    motions: tuple[Motion, ...],
    options: MultiStepOptions | None = None,
    *,
    chosen: frozenset[BlockKey] | None = None,
    progress: Progress | None = None,
) -> MultiStep:
    """Simulate every window of the chosen blocks (all by default) and compare.

    Raises
    ------
    LogError
        If no block is as long as the longest horizon.
    SolverError
        If a simulation diverges.
    """
    asked = options or MultiStepOptions()
    found: list[tuple[np.ndarray, ...]] = []
    keys: list[BlockKey] = []
    begins: list[np.ndarray] = []
    drive = partial(driving_torque, mechanism)
    for group in windows(motions, asked.horizons[-1], asked.every, chosen, drive=drive):
        keys += group.keys
        begins.append(group.begins)
        for start in range(0, len(group.keys), _AT_ONCE):
            found.append(_errors(mechanism, group, slice(start, start + _AT_ONCE), asked))
            if progress is not None:
                progress(min(1.0, (start + _AT_ONCE) / len(group.keys)))
    position, velocity, still = (np.concatenate([part[index] for part in found]) for index in range(3))
    return MultiStep(asked.horizons, tuple(keys), np.concatenate(begins), position, velocity, still)


@dataclass(frozen=True, eq=False)
class Comparison:
    """Hold the same windows simulated by two models."""

    before: MultiStep
    after: MultiStep

    @property
    def gain_percent(self) -> Matrix:
        """Give by how much the RMS error in position fell, per horizon and joint; negative where it rose."""
        before = self.before.position_rms
        fallen = before - self.after.position_rms
        return np.asarray(100.0 * np.divide(fallen, before, out=np.zeros_like(before), where=before > 0.0))

    @property
    def total_gain_percent(self) -> JointVector:
        """Give the same per joint over all horizons, each weighed by its inverse square."""
        weights = np.array(self.before.horizons) ** -2.0
        old, new = (np.sqrt(weights @ errors.position_rms**2) for errors in (self.before, self.after))
        return np.asarray(100.0 * np.divide(old - new, old, out=np.zeros_like(old), where=old > 0.0))


def compare(
    before: Mechanism,
    after: Mechanism,
    motions: tuple[Motion, ...],
    options: MultiStepOptions | None = None,
    *,
    chosen: frozenset[BlockKey] | None = None,
) -> Comparison:
    """Simulate the same windows with two models."""
    return Comparison(
        predict_motion(before, motions, options, chosen=chosen),
        predict_motion(after, motions, options, chosen=chosen),
    )


def _errors(
    mechanism: Mechanism, group: Windows, part: slice, asked: MultiStepOptions
) -> tuple[np.ndarray, ...]:
    lanes = np.arange(len(group.keys))[part]
    torque, position, velocity = (
        np.take(series, lanes, axis=2) for series in (group.torque, group.position, group.velocity)
    )
    start = States.starting(mechanism, group.start).chosen(lanes)
    drive = Drive(group.step, torque)
    moved = rollout(mechanism, start, drive, longest_step=asked.longest_step)
    at = np.rint(np.array(asked.horizons) / group.step).astype(int)
    kept = position[0] + (at * group.step)[:, None, None] * velocity[0]
    errors = (moved.position[at] - position[at], moved.velocity[at] - velocity[at], kept - position[at])
    return tuple(error.transpose(2, 0, 1) for error in errors)


def _rms(errors: np.ndarray) -> Matrix:
    return np.asarray(np.sqrt(np.mean(errors**2, axis=0)))
