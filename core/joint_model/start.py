"""Find a model to begin with: least squares behind state-variable filters, and a grid of modes.

Least squares filters everything by one polynomial with all poles at a cut-off. Noise of positions biases it.
The flexible model therefore begins at the best points of a grid. Source: Young 1981, Automatica 17.
"""

from collections.abc import Iterator
from typing import Final

import numpy as np

from ..arrays import Vector
from ..errors import ExcitationError, SolverError
from .orders import FLEXIBLE, RIGID, TIME_UNIT
from .refined_iv import Fitted, fit, residual
from .responses import powers, transients
from .task import Model, Task

RIGID_CUTOFFS_HZ: Final = (0.5, 2.0, 8.0)
"""Cut-offs that the rigid model begins with: motions of joints lie within 10 Hz."""
FEWEST_HZ: Final = 3.0
"""Lowest mode of the grid: softer joints than that are springs."""
GRID: Final = 7
"""Frequencies of the grid, up to `HIGHEST_SHARE` of the rate: neighbours differ by about two at 1 kHz."""
HIGHEST_SHARE: Final = 0.25
MOTOR_SHARES: Final = (0.15, 0.5, 0.85)
"""Shares of the motor in the whole inertia that the grid holds."""
FIRST_STEPS: Final = 4
"""Steps after which starts are compared."""
TRIED: Final = 6
"""Points of the grid that are refined: those of the smallest innovations."""
BEST: Final = 1
"""Refined ones that go on."""


def rigid_start(task: Task) -> Model:
    """Give the rigid model by least squares.

    Raises
    ------
    ExcitationError
        If no cut-off gives a model with a positive inertia.
    """
    found = [_least_squares(task, 2.0 * np.pi * cutoff * TIME_UNIT) for cutoff in RIGID_CUTOFFS_HZ]
    models = [model for model in found if model is not None]
    if not models:
        raise ExcitationError(
            "torque and motion do not belong to a mass with friction: the joint's inertia is negative",
            evidence={"cutoffs_hz": list(RIGID_CUTOFFS_HZ)},
            remedy="check the sign of the torque and the units; let the joint speed up and slow down more",
        )
    return min(models, key=lambda model: residual(model, task).innovation(task.fitted))


def flexible_start(rigid: Model, task: Task) -> Fitted:
    """Give the best flexible model that a grid of modes leads to.

    Raises
    ------
    SolverError
        If none leads to any.
    """
    found = sorted(_refined(rigid, task), key=lambda pair: pair[0])[:BEST]
    finished = []
    for _, model in found:
        try:
            finished.append(fit(model, task))
        except SolverError:
            continue
    if not finished:
        raise SolverError(
            "no flexible model of the joint is found",
            evidence={"starts": len(MOTOR_SHARES) * GRID, "lowest_hz": FEWEST_HZ},
            remedy="let the joint move with frequencies up to its mode, or ask for the rigid model",
        )
    return min(finished, key=lambda one: one.steps[-1].innovation)


def _refined(rigid: Model, task: Task) -> Iterator[tuple[float, Model]]:
    ranked = sorted(_tried(rigid, task), key=lambda pair: pair[0])
    for _, model in ranked[:TRIED]:
        try:
            refined = fit(model, task, most=FIRST_STEPS)
        except SolverError:
            continue
        yield refined.steps[-1].innovation, refined.model


def _tried(rigid: Model, task: Task) -> Iterator[tuple[float, Model]]:
    for model in _grid(rigid, task.step):
        try:
            yield residual(model, task).innovation(task.fitted), model
        except SolverError:
            continue


def _grid(rigid: Model, step: float) -> Iterator[Model]:
    """Give flexible models of the rigid one's inertia and friction."""
    inertia, viscous = RIGID.physical(rigid.coefficients)
    highest = HIGHEST_SHARE * TIME_UNIT**-1 / step
    for frequency in np.geomspace(FEWEST_HZ, highest, GRID):
        for share in MOTOR_SHARES:
            motor, link = share * inertia, (1.0 - share) * inertia
            speed = 2.0 * np.pi * frequency
            stiffness = speed**2 * motor * link / inertia
            damping = 0.04 * stiffness / speed
            quantities = np.array([motor, link, stiffness, damping, max(viscous, 0.0)])
            yield Model(FLEXIBLE, FLEXIBLE.coefficients(quantities), rigid.loads)


def _least_squares(task: Task, cutoff: float) -> Model | None:
    """Fit the rigid model behind a filter with two poles at the cut-off, rad per time unit."""
    poles = np.real(np.poly([-cutoff, -cutoff]))
    position = powers(poles, task.position, task.step, "first")
    torque = powers(poles, task.signals.torque, task.step, "zero")[:, 0]
    loads = [-powers(poles, load, task.step, "zero")[:, 0] for load in task.signals.loads.T]
    columns = [-position[:, 1], torque, *loads, *transients(poles, len(torque), task.step).T]
    table = np.column_stack(columns)[: task.fitted]
    scale = np.linalg.norm(table, axis=0)
    scale[scale == 0.0] = 1.0
    solved = np.linalg.lstsq(table / scale, position[: task.fitted, 2], rcond=None)[0] / scale
    gain, count = float(solved[1]), len(loads)
    if not gain > 0.0:
        return None
    decay = abs(float(solved[0]))
    loads_found: Vector = np.asarray(solved[2 : 2 + count] / gain)
    return Model(RIGID, np.array([decay, gain]), loads_found)
