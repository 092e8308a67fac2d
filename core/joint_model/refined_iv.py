r"""Estimate a transfer function by refined instrumental variables, in continuous time.

A(s) q = B(s) u + e with u the torque less friction, offset and gravity. Everything is filtered by 1 / C,
where C C* = A A* + rho^2 B B* whitens noise of positions and of torques together; without noise of torques C
is A, which is SRIVC. Instruments Z are the columns of a motion without noise. Each step d solves
Z' (r - Phi d) = 0. The residual r = (A / C)(q - (B / A) u) holds no error of interpolation. Sources: Young,
Garnier & Gilson 2008; Gilson, Garnier, Young & Van den Hof 2011 (closed loop).
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np

from ..arrays import Matrix, Samples, SquareMatrix, Vector
from ..errors import SolverError
from .orders import TIME_UNIT
from .responses import feedthrough, filtered, lower_powers, powers, spectral_factor, transients
from .task import Model, Signals, Task

MOST_STEPS: Final = 20
CONVERGED: Final = 1e-4
"""Change that ends the steps: of every coefficient as a share of it, or of its deviation if that is larger;
of loads also of the torque's RMS. Further steps change nothing that the deviations show."""
_HALVINGS: Final = 5
_RISE: Final = 1.02
"""Ratio of innovations' RMS above which a step is halved. The equations of instruments have their solution
near the smallest innovations, not there."""
BLOCKS: Final = 60
"""Blocks of rows whose sums are taken for independent: each has hundreds of rows, and 60 give a deviation to
10 %."""
_REMEMBERED: Final = 4
"""Models whose residuals are kept: a step is judged by what it leaves, and the next one begins there."""
_SINGULAR: Final = 1e-13
"""Columns depend on each other where a singular value of the equations is this share of the largest."""


@dataclass(frozen=True, eq=False)
class Step:
    """Record a step: largest change of a coefficient as a share of it, and RMS of the innovations."""

    change: float
    innovation: float


@dataclass(frozen=True, eq=False)
class Fitted:
    """Hold a fit."""

    model: Model
    covariance: SquareMatrix
    """Of coefficients and loads."""
    steps: tuple[Step, ...]
    converged: bool
    task: Task


@dataclass(frozen=True, eq=False)
class Residual:
    """Hold what a model leaves of the position, filtered by A / C."""

    values: Samples
    transients: Matrix
    """What any beginning leaves behind."""
    feedthrough: float
    """By how much a sample of position enters its own residual."""

    def settled(self, fitted: int) -> Samples:
        """Give it without transients, which are fitted over the first rows."""
        found = np.linalg.lstsq(self.transients[:fitted], self.values[:fitted], rcond=None)[0]
        return np.asarray(self.values - self.transients @ found)

    def innovation(self, fitted: int) -> float:
        """Give the RMS of innovations over the first rows, on one scale for all C."""
        return float(np.std(self.settled(fitted)[:fitted]) / self.feedthrough)


@lru_cache(maxsize=_REMEMBERED)
def denominators(model: Model, crossover: float) -> tuple[Vector, Vector]:
    """Give A and C."""
    order = model.order
    denominator = order.denominator(model.coefficients)
    ratio = abs(order.inertia(model.coefficients)) * crossover**2
    return denominator, spectral_factor(denominator, order.numerator(model.coefficients), ratio)


@lru_cache(maxsize=_REMEMBERED)
def residual(model: Model, task: Task) -> Residual:
    """Give what a model leaves of the measured position.

    Raises
    ------
    SolverError
        If the model's motion is beyond all numbers.
    """
    denominator, noise = denominators(model, task.crossover)
    left = task.position - _driven(model, task.signals, denominator, task.step)
    if not np.isfinite(left).all():
        raise _diverged(model)
    states = lower_powers(noise, left, task.step, "first")
    missing = (noise - denominator)[:0:-1]
    return Residual(
        left - states @ missing,
        transients(noise, len(left), task.step),
        feedthrough(denominator, noise, task.step),
    )


def torque_part(model: Model, task: Task) -> Samples:
    """Give the part of the torque in the filtered position: B / C times it."""
    _, noise = denominators(model, task.crossover)
    numerator = model.order.numerator(model.coefficients)
    return filtered(numerator, noise, task.signals.torque, task.step, "zero")


def fit(model: Model, task: Task, *, most: int = MOST_STEPS) -> Fitted:
    """Solve the equations of instrumental variables, from a model that is near enough.

    Raises
    ------
    SolverError
        If a step's equations are singular, or the model diverges.
    """
    steps: list[Step] = []
    for _ in range(most):
        equations = _Equations(model, task)
        move, deviation = equations.solution()
        model, innovation = _damped(model, task, move)
        scale = np.maximum(np.abs(model.unknowns), deviation)
        scale[len(model.coefficients) :] += _rms(task.signals.torque)
        steps.append(Step(float(np.max(np.abs(move) / np.where(scale > 0.0, scale, 1.0))), innovation))
        if steps[-1].change < CONVERGED:
            break
    covariance = _Equations(model, task).covariance()
    return Fitted(model, covariance, tuple(steps), steps[-1].change < CONVERGED, task)


def torque_delay(fitted: Fitted) -> tuple[float, float]:
    """Give by how much later than it acted the torque stands in the log, and the standard deviation, s.

    To first order a late torque u(t - T) leaves T (B / C) s u in the residual. It is one more unknown of the
    last step, all others free.
    """
    model, task = fitted.model, fitted.task
    _, noise = denominators(model, task.crossover)
    rates = np.append(model.order.numerator(model.coefficients), 0.0)
    own, clean = (
        filtered(rates, noise, signals.torque, task.step, "zero")[: task.fitted]
        for signals in (task.signals, task.instruments(model))
    )
    late, deviation = _Equations(model, task).one_more(own, clean)
    return late * TIME_UNIT, deviation * TIME_UNIT


def _damped(model: Model, task: Task, move: Vector) -> tuple[Model, float]:
    """Go as much of a step as lowers the innovations."""
    before = residual(model, task).innovation(task.fitted)
    best: tuple[Model, float] | None = None
    for halving in range(_HALVINGS + 1):
        tried = model.moved(0.5**halving * move)
        after = _innovation(tried, task)
        if best is None or after < best[1]:
            best = tried, after
        if after <= before * _RISE:
            return tried, after
    if best is None or not np.isfinite(best[1]):
        raise _diverged(model)
    return best


def _innovation(model: Model, task: Task) -> float:
    try:
        return residual(model, task).innovation(task.fitted)
    except SolverError:
        return np.inf


class _Equations:
    """Hold the equations of one step, of coefficients and loads first, then of transients."""

    def __init__(self, model: Model, task: Task) -> None:
        left = residual(model, task)
        _, noise = denominators(model, task.crossover)
        instruments = task.instruments(model)
        position = powers(noise, task.position, task.step, "first")
        speed = _speed(model, instruments, task.step)
        simulated = powers(noise, speed, task.step, "first")
        rows = slice(0, task.fitted)
        size = model.order.states
        own = [_columns(model, task.signals, noise, task.step), left.transients]
        other = [_columns(model, instruments, noise, task.step), left.transients]
        measured = np.column_stack([-position[:, size - 1 : 0 : -1], *own])[rows]
        clean = np.column_stack([-simulated[:, size - 2 :: -1], *other])[rows]
        self.scale = np.linalg.norm(clean, axis=0)
        self.scale[self.scale == 0.0] = 1.0
        self.regressors, self.instruments = measured / self.scale, clean / self.scale
        self.residual = left.values[rows]
        self.unknowns = len(model.unknowns)
        self.matrix = self.instruments.T @ self.regressors
        values = np.linalg.svd(self.matrix, compute_uv=False)
        if not np.all(np.isfinite(values)) or values[-1] < _SINGULAR * values[0]:
            raise SolverError(
                "the motion of the joint does not determine its model",
                evidence={
                    "order": model.order.name,
                    "condition_number": float(values[0] / max(values[-1], 1e-300)),
                },
                remedy="let the joint move with more frequencies, and both ways",
            )

    def solution(self) -> tuple[Vector, Vector]:
        """Give the step of coefficients and loads, and their standard deviations for white innovations."""
        move = np.linalg.solve(self.matrix, self.instruments.T @ self.residual)
        left = self.residual - self.regressors @ move
        solved = np.linalg.solve(self.matrix, self.instruments.T)
        deviation = np.std(left) * np.linalg.norm(solved, axis=1)
        return (move / self.scale)[: self.unknowns], (deviation / self.scale)[: self.unknowns]

    def covariance(self) -> SquareMatrix:
        """Give the covariance of coefficients and loads."""
        _, root = _solved(self.regressors, self.instruments, self.residual)
        root = (root / self.scale[:, None])[: self.unknowns]
        return np.asarray(root @ root.T)

    def one_more(self, regressor: Samples, instrument: Samples) -> tuple[float, float]:
        """Give the step of one more unknown with its own column, and its standard deviation."""
        size = float(np.linalg.norm(instrument))
        columns = np.column_stack([self.regressors, regressor / size])
        move, root = _solved(columns, np.column_stack([self.instruments, instrument / size]), self.residual)
        return float(move[-1]) / size, float(np.linalg.norm(root[-1])) / size


def _solved(regressors: Matrix, instruments: Matrix, residual: Samples) -> tuple[Vector, Matrix]:
    """Solve, and give a root of the covariance, unknowns x blocks.

    It is the sandwich of sums over blocks of rows, which innovations with memory leave valid. Source: Bell &
    McCaffrey 2002, Survey Methodology 28 (the factor for few blocks).
    """
    matrix = instruments.T @ regressors
    move = np.linalg.solve(matrix, instruments.T @ residual)
    scores = instruments * (residual - regressors @ move)[:, None]
    borders = np.linspace(0, len(scores), BLOCKS, endpoint=False).astype(int)
    sums = np.add.reduceat(scores, borders, axis=0)
    factor = BLOCKS / max(BLOCKS - len(move), 1)
    return move, np.sqrt(factor) * np.linalg.solve(matrix, sums.T)


def _driven(model: Model, signals: Signals, denominator: Vector, step: float) -> Samples:
    """Give B / A times what acts on the joint: its position, from rest."""
    order, coefficients = model.order, model.coefficients
    motor = signals.torque - signals.loads[:, ~signals.on_link] @ model.loads[~signals.on_link]
    driven = filtered(order.numerator(coefficients), denominator, motor, step, "zero")
    if signals.on_link.any():
        link = signals.loads[:, signals.on_link] @ model.loads[signals.on_link]
        driven = driven - filtered(order.link_numerator(coefficients), denominator, link, step, "zero")
    return np.asarray(driven)


def _speed(model: Model, signals: Signals, step: float) -> Samples:
    """Give the speed: what acts on the joint by B over A / s."""
    return _driven(model, signals, model.order.denominator(model.coefficients)[:-1], step)


def _columns(model: Model, signals: Signals, noise: Vector, step: float) -> Matrix:
    """Give the derivative of (B / C) u by the coefficients of B and by the loads."""
    order, coefficients, size = model.order, model.coefficients, model.order.states
    motor = signals.torque - signals.loads[:, ~signals.on_link] @ model.loads[~signals.on_link]
    link = signals.loads[:, signals.on_link] @ model.loads[signals.on_link]
    both = powers(noise, motor - link, step, "zero")[:, size - 2 :: -1]
    if size > 2 and signals.on_link.any():
        both[:, 0] = powers(noise, motor, step, "zero")[:, size - 2]
    loads = [
        -filtered(
            order.link_numerator(coefficients) if on_link else order.numerator(coefficients),
            noise,
            series,
            step,
            "zero",
        )
        for series, on_link in zip(signals.loads.T, signals.on_link, strict=True)
    ]
    return np.column_stack([both, *loads])


def _rms(values: Samples) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _diverged(model: Model) -> SolverError:
    return SolverError(
        "the motion of the model diverges",
        evidence={
            "order": model.order.name,
            "coefficients": [float(f"{value:.6g}") for value in model.coefficients],
            "time_unit_s": TIME_UNIT,
        },
        remedy="check the sign and the unit of the torque; let the joint move with more frequencies",
    )
