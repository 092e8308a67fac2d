"""Follow the state and the base parameters of a robot along a log, in pieces: a Kalman filter of the scheme.

The measured torque drives the scheme by which robots are simulated here, friction at rest included, and the
measured positions correct it. Sources: see `filter_kernel`.
"""

from dataclasses import dataclass, replace

import numpy as np

from ...arrays import (
    BaseParameters,
    JointMarks,
    JointSeries,
    JointVector,
    Matrix,
    Parameters,
    SquareMatrix,
    Vector,
)
from ...errors import OptionError, SolverError
from ...reduction.base import BaseModel
from ..closed_loop.loop import not_compiled
from ..mechanism import Mechanism, mechanism_of
from . import filter_kernel as kernel

ONE_SIDED = 0.3
"""Length of the extended filter's differences, in deviations. Smaller ones do not see that a joint may slide
which rests by the mean: on a simulated arm of six joints 1e-3 errs twice as much, and 1 as much as 0.3."""
ALPHA, BETA = 0.3, 2.0
"""Spread of the sigma points, and the weight of their centre that suits normal deviations. Source: van der
Merwe & Wan 2001."""
_LEVELS = ("FC", "FCM")


@dataclass(frozen=True, eq=False)
class FilterState:
    """Hold what a filter knows between two samples."""

    mean: Vector
    """Base parameters, positions, and velocities half a step before."""
    factor: SquareMatrix
    """Upper triangle U of the covariance U'U."""
    memory: Matrix
    """See `filter_kernel.MEMORY_ROWS`."""
    held: Vector
    """Torque of every friction."""
    fresh: bool
    """Whether no sample has been taken in yet."""
    samples: int = 0
    shortened: int = 0
    """Samples that have been taken in, and those of them at which a parameter had to differ by less."""

    def drifted(self, deviation: Vector) -> "FilterState":
        """Give the state after independent random steps of the parameters, of such deviations."""
        steps = np.zeros((len(deviation), len(self.mean)))
        np.fill_diagonal(steps, deviation)
        factor = np.asarray(np.linalg.qr(np.vstack([self.factor, steps]), mode="r"))
        return replace(self, factor=factor)


@dataclass(frozen=True, eq=False)
class Clock:
    """Hold the time between samples, s, and the steps of the integration from each to the next."""

    step: float
    substeps: int


@dataclass(frozen=True, eq=False)
class StateFilter:
    """Hold a robot whose parameters are followed, its noise, and the clock; build it with `filter_of`."""

    mechanism: Mechanism
    reference: BaseParameters
    """Base parameters at which the mechanism is."""
    tangent: tuple[np.ndarray, np.ndarray, np.ndarray]
    """What base parameters change of the mechanism's numbers: places, parameters, slopes."""
    variance: JointVector
    """Of the measured positions, rad2 or m2."""
    clock: Clock
    unscented: bool

    @property
    def size(self) -> int:
        """Count the numbers of the state."""
        return len(self.reference) + 2 * self.mechanism.joints

    def started(self, mean: Vector, factor: SquareMatrix, speed: JointVector) -> FilterState:
        """Begin at a mean: parameters of covariance factor' factor, positions, speeds known up to `speed`."""
        joints, known = self.mechanism.joints, len(self.reference)
        whole = np.zeros((self.size, self.size))
        whole[:known, :known] = factor
        whole[known:, known:] = np.diag(np.concatenate([np.sqrt(self.variance), speed]))
        memory = np.zeros((kernel.MEMORY_ROWS, joints))
        return FilterState(mean, whole, memory, np.zeros(len(self.mechanism.levels)), fresh=True)

    def known(self, state: FilterState) -> tuple[BaseParameters, SquareMatrix]:
        """Give the base parameters, and the triangle U of their covariance U'U."""
        size = len(self.reference)
        return state.mean[:size], state.factor[:size, :size]

    def run(
        self, state: FilterState, position: JointSeries, torque: JointSeries, noise: JointSeries
    ) -> tuple[JointSeries, FilterState]:
        """Take samples in; gives what was not foreseen of the positions, in its deviations, and the state.

        Raises
        ------
        SolverError
            If the motion diverges, or the mass matrix is not positive definite near the estimate.
        """
        mean, factor, memory, held = (
            part.copy() for part in (state.mean, state.factor, state.memory, state.held)
        )
        samples = tuple(np.ascontiguousarray(part, dtype=float) for part in (position, torque, noise))
        missed = np.zeros_like(samples[0])
        length = ALPHA * np.sqrt(self.size) if self.unscented else ONE_SIDED
        rule = (float(length), self.unscented, float(np.sqrt(BETA - ALPHA**2)))
        failed, shortened = kernel.follow(
            self.mechanism.bodies,
            self.mechanism.weights,
            self.tangent,
            _numbers(self.mechanism),
            self.reference,
            self.variance,
            samples,
            mean,
            factor,
            memory,
            held,
            missed,
            rule,
            (self.clock.step / self.clock.substeps, self.clock.substeps),
            state.fresh,
        )
        size, joints = len(self.reference), self.mechanism.joints
        if failed >= 0:
            raise SolverError(
                "the filter lost the robot: it foresees a motion that diverges",
                evidence={"samples": state.samples + failed, "position": mean[size : size + joints].tolist()},
                remedy="give kalman a smaller start_scale or drift, or fit with sdp or didim",
            )
        taken, many = state.samples + len(missed), state.shortened + shortened
        return missed, FilterState(mean, factor, memory, held, fresh=False, samples=taken, shortened=many)


def filter_of(
    base: BaseModel,
    standard: Parameters,
    variance: JointVector,
    clock: Clock,
    *,
    held: JointMarks,
    unscented: bool,
) -> StateFilter:
    """Prepare to follow the base parameters, each by the one standard parameter that is named after it.

    Parameters
    ----------
    held
        The joints that stand all the time.

    Raises
    ------
    OptionError
        If the model has terms that are not compiled.
    """
    model, floored = base.model, np.array(standard, dtype=float)
    levels = np.array([parameter.symbol in _LEVELS for parameter in model.parameters])
    floored[levels] = np.maximum(floored[levels], kernel.LEAST_LEVEL)
    mechanism = mechanism_of(model, floored).holding(held)
    left = not_compiled(mechanism)
    if left:
        raise OptionError(
            "a filter does not simulate all terms of the model",
            evidence={"terms": left},
            remedy="leave these terms out, or fit with sdp",
        )
    origin = _numbers(mechanism)
    size = np.maximum(np.abs(floored), 1.0)
    slopes = [
        _slope(
            mechanism_of(model, floored + own * (np.arange(len(size)) == column)).holding(held), origin, own
        )
        for column, own in zip(base.kept, size[list(base.kept)], strict=True)
    ]
    parameter, place = (np.ascontiguousarray(index) for index in np.nonzero(np.array(slopes)))
    tangent = (place, parameter, np.array(slopes)[parameter, place])
    return StateFilter(mechanism, base.base_of(floored), tangent, variance, clock, unscented)


def _slope(other: Mechanism, origin: Vector, size: float) -> Vector:
    """Give what a standard parameter changes of the mechanism's numbers, which it does in proportion."""
    slope = (_numbers(other) - origin) / size
    return np.where(np.abs(slope) > 1e-12, slope, 0.0)


def _numbers(mechanism: Mechanism) -> Vector:
    """Put all numbers of a mechanism that parameters change into one row."""
    drives = mechanism.inertia, mechanism.damping, mechanism.offset, mechanism.levels
    parts = (*mechanism.bodies[-2:], *drives)
    return np.concatenate([np.ravel(part) for part in parts])
