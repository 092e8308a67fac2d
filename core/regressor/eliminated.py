"""Write the rows of an arm with flexible joints: the links' motion is what torque and springs say it is.

A motor's torque, less what the motor itself takes, is what its spring carries: k x + d dx = tau - motor. So
the link lies at q - x. With that, the rows of motors and links together are linear in their
parameters, and each spring's own derivative is the mass matrix times the change of its travel's acceleration.
Source: De Luca & Book, Springer Handbook of Robotics (2016), ch. 11.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..arrays import BaseParameters, Indices, JointSeries, Samples, Vector
from ..dynamics.terms.effect import rates, step_of
from ..dynamics.terms.flexible_joints import DAMPING, STIFFNESS
from ..numerics.filtering import convolved
from ..signals.parallel import Tile
from ..signals.recipe import Recipe
from ..signals.state import MotionState
from ..signals.zero_phase import kernel
from .columns import ColumnPlan
from .factor import REGRESSOR, TARGET, FilteredRows, Groups
from .rows import Tiled, equations

ROTOR = "IA"
Masses = Callable[[JointSeries], np.ndarray]


@dataclass(frozen=True, eq=False)
class Transmission:
    """Hold what stands between torques and links: per flexible joint."""

    joints: Indices
    """The joints (from 0)."""
    stiffness: Vector
    damping: Vector
    """N m/rad and N m s/rad."""
    rotor: Vector
    viscous: Vector
    coulomb: Vector
    offset: Vector
    """What the motors take: kg m2, N m s/rad, N m, N m."""

    def behind(self, torque: JointSeries, step: float) -> JointSeries:
        """Give how far springs and dampers give way under torques, which rest before the first sample."""
        return np.column_stack(
            [
                _yielded(own, stiffness, damping, step)
                for own, stiffness, damping in zip(torque.T, self.stiffness, self.damping, strict=True)
            ]
        )

    def carried(self, tile: Tile, recipe: Recipe) -> JointSeries:
        """Give what the springs carry, smoothed like the positions."""
        state, joints = tile.state, self.joints
        velocity = state.velocity[:, joints]
        pushed = tile.torque[:, joints] - self.coulomb * state.direction[:, joints]
        taken = self.rotor * state.acceleration[:, joints] + self.viscous * velocity + self.offset
        return np.asarray(smoothed(pushed, recipe, step_of(state)) - taken)


def smoothed(series: JointSeries, recipe: Recipe, step: float) -> JointSeries:
    """Filter series as positions are filtered; beyond its ends a series is continued by its end values."""
    response = kernel(recipe.position_cutoff_hz, 1.0 / step, recipe.order)
    reach = len(response) // 2
    padded = np.pad(series, ((reach, reach), (0, 0)), mode="edge")
    return convolved(padded, response)


def _yielded(torque: Samples, stiffness: float, damping: float, step: float) -> Samples:
    """Solve k x + d dx = torque by the trapezoidal rule."""
    from scipy.signal import lfilter  # takes a second to load

    held = 2.0 * damping / step
    weights = [stiffness + held, stiffness - held]
    return np.asarray(lfilter([1.0, 1.0], weights, torque - torque[0]) + torque[0] / stiffness)


@dataclass(frozen=True, eq=False)
class EliminatedRows:
    """Make rows [J, y + D base]: columns W of motors and links, with J = W + D.

    D are the derivatives by what moves the links. Without them rows are [W y], by which a model is judged.
    """

    plan: ColumnPlan
    transmission: Transmission
    recipes: Sequence[Recipe]
    """Per motion."""
    base: BaseParameters
    """Base parameters of the plan's columns, at which the rows are written."""
    masses: Masses | None = None
    """Gives the links' mass matrices over positions; None for rows without derivatives."""
    damped: bool = True
    """Whether the damping's derivatives are among them."""

    @cached_property
    def columns_of(self) -> tuple[Indices, ...]:
        """Give, per joint, the base parameters that its columns belong to."""
        if self.masses is None:
            return self.plan.columns_of
        return (np.arange(len(self.base)),) * len(self.plan.columns_of)

    @cached_property
    def groups(self) -> tuple[Groups, ...]:
        """Give, per joint, what the columns of its rows are."""
        return tuple(((REGRESSOR, len(own)), (TARGET, 1)) for own in self.columns_of)

    def rows(self, number: int, motion: Tiled) -> Iterator[tuple[Tile, list[FilteredRows]]]:
        """Go through a motion."""
        for measured in motion.tiles():
            tile, given = self._flexed(measured, self.recipes[number])
            plain = list(equations(self.plan, tile))
            if self.masses is not None:
                plain = list(self._differentiated(tile, given, plain, self.masses(tile.state.links.position)))
            yield tile, plain

    def _flexed(self, tile: Tile, recipe: Recipe) -> tuple[Tile, JointSeries]:
        """Give the tile with the links' motion, and the way that the springs give."""
        state, joints = tile.state, self.transmission.joints
        given = self.transmission.behind(self.transmission.carried(tile, recipe), step_of(state))
        links = [np.array(part) for part in (state.position, state.velocity, state.acceleration)]
        for part, way in zip(links, (given, *rates(given, state)), strict=True):
            part[:, joints] -= way
        position, velocity, acceleration = links
        flexed = replace(
            state, link_position=position, link_velocity=velocity, link_acceleration=acceleration
        )
        return replace(tile, state=flexed), given

    def _differentiated(
        self, tile: Tile, given: JointSeries, plain: list[FilteredRows], masses: np.ndarray
    ) -> Iterator[FilteredRows]:
        moved = self._moved(tile.state, given)
        own = self.transmission.joints
        for joint, (rows, usable) in enumerate(plain):
            whole = np.zeros((len(rows), len(self.base) + 1))
            whole[:, self.plan.columns_of[joint]] = rows[:, :-1]
            columns, series = zip(
                *((place, masses[:, joint, own[at]] * way) for place, at, way in moved), strict=True
            )
            added = tile.filtered(np.ascontiguousarray(series))
            whole[:, columns] += added.T
            whole[:, -1] = rows[:, -1] + added.T @ self.base[list(columns)]
            yield whole, usable

    def _moved(self, state: MotionState, given: JointSeries) -> list[tuple[int, int, Samples]]:
        """List, per parameter that moves a link, its column, the spring, and the change of acceleration."""
        own, step = self.transmission, step_of(state)
        speed, bend = rates(given, state)
        jerk = rates(speed, state)[1]
        rotor = rates(own.behind(state.acceleration[:, own.joints], step), state)[1]
        found = list[tuple[int, int, Samples]]()
        for at, joint in enumerate(own.joints):
            found.append((column_of(self.plan, ROTOR, joint), at, rotor[:, at]))
            found.append((column_of(self.plan, STIFFNESS, joint), at, bend[:, at] / own.stiffness[at]))
            if self.damped:
                found.append((column_of(self.plan, DAMPING, joint), at, jerk[:, at] / own.stiffness[at]))
        return found


def column_of(plan: ColumnPlan, symbol: str, joint: int) -> int:
    """Give the position among a plan's columns of a drive's parameter; the joint counts from 0."""
    names = [plan.model.parameters[column].name for column in plan.columns]
    return names.index(f"{symbol}{joint + 1}")


@dataclass(frozen=True, eq=False)
class SpringRows:
    """Make rows [W, -tau'', q'''', q''', y]: those of rigid joints, and what a spring adds to its own joint.

    To first order in the compliance 1/k, the spring adds M/k times the second derivative of what it carries.
    The columns after those of the plan are three per flexible joint.
    """

    plan: ColumnPlan
    joints: Indices
    recipes: Sequence[Recipe]

    @cached_property
    def columns_of(self) -> tuple[Indices, ...]:
        """Give, per joint, the columns that are not zero."""
        size, found = len(self.plan.columns), list(self.plan.columns_of)
        for at, joint in enumerate(self.joints):
            found[joint] = np.append(found[joint], size + 3 * at + np.arange(3))
        return tuple(found)

    @cached_property
    def groups(self) -> tuple[Groups, ...]:
        """Give, per joint, what the columns of its rows are."""
        return tuple(((REGRESSOR, len(own)), (TARGET, 1)) for own in self.columns_of)

    def rows(self, number: int, motion: Tiled) -> Iterator[tuple[Tile, list[FilteredRows]]]:
        """Go through a motion."""
        for tile in motion.tiles():
            state, found = tile.state, list(equations(self.plan, tile))
            torque = smoothed(tile.torque[:, self.joints], self.recipes[number], step_of(state))
            jerk, snap = rates(state.acceleration[:, self.joints], state)
            bent = rates(torque, state)[1]
            for at, joint in enumerate(self.joints):
                own = tile.filtered(np.ascontiguousarray([-bent[:, at], snap[:, at], jerk[:, at]]))
                rows, usable = found[joint]
                found[joint] = np.column_stack([rows[:, :-1], own.T, rows[:, -1]]), usable
            yield tile, found
