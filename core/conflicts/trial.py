"""Try a set-up: fit the standard model with its constraints to some instants, and judge it on others.

Signs and exchanged channels hardly change plain least squares. They change whether a body is possible, so
that only the feasible fit tells them. The instants are few and the question is coarse, so that the equations
are kept as products W'W and W'y, which set-ups with the same motion share.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ..arrays import BaseParameters, Indices, JointVector, Matrix, SampleMask, Series, Vector, Vector3
from ..dynamics.model import standard_model
from ..dynamics.terms.coulomb import Coulomb
from ..errors import SolverError
from ..estimate.constraints import Bounds, default_prior
from ..estimate.estimate import solve
from ..estimate.programme import Programme
from ..reduction.base import BaseModel, base_model
from ..regressor.columns import ColumnPlan
from ..robot.model import Link, RobotModel
from .normal import Normal, crossed, mean_log, towards
from .samples import Samples
from .setup import Setup

_GENERAL = np.array([0.37, -0.54, -0.75])
"""A direction of gravity along no axis: base parameters for it span those of any other direction."""


@dataclass(frozen=True, eq=False)
class Regressor:
    """Hold the observation matrix of a set-up's motion, joint by joint."""

    base: BaseModel
    columns_of: tuple[Indices, ...]
    fitted: tuple[Matrix, ...]
    judged: tuple[Matrix, ...]

    @cached_property
    def products(self) -> np.ndarray:
        """Give W'W of the fitted rows per joint."""
        return crossed(self.fitted, self.fitted, self.columns_of, len(self.base.kept))


@dataclass(frozen=True, eq=False)
class Equations:
    """Hold a set-up's equations: its regressor, and the torques of the fitted and of the judging rows."""

    regressor: Regressor
    fitted: tuple[Vector, ...]
    judged: tuple[Vector, ...]

    @cached_property
    def normal(self) -> Normal:
        """Give the products of the fitted rows."""
        own = self.regressor
        moments = towards(own.fitted, self.fitted, own.columns_of, len(own.base.kept))
        return Normal(own.products, moments, *self.sizes)

    @property
    def sizes(self) -> tuple[JointVector, JointVector]:
        """Give the squared torque and the number of the fitted rows per joint."""
        squares = np.array([torque @ torque for torque in self.fitted])
        return squares, np.array([float(max(len(torque), 1)) for torque in self.fitted])

    def judged_errors(self, base: BaseParameters) -> JointVector:
        """Give the same of the rows that judge; one for a joint without torque."""
        parts = zip(self.regressor.judged, self.regressor.columns_of, self.judged, strict=True)
        pairs = [(rows @ base[columns] - torque, torque) for rows, columns, torque in parts]
        return np.array([_relative(left, torque) for left, torque in pairs])


@dataclass(frozen=True, eq=False)
class Outcome:
    """Hold how well a set-up predicts."""

    errors: JointVector
    """RMS residual over RMS torque per joint, on the rows that judge."""
    fitted: float
    """Mean logarithm of the same on the rows that were fitted."""
    bound: float
    """What it would be there without constraints."""

    @property
    def score(self) -> float:
        """Give the mean logarithm of the joints' errors."""
        return mean_log(self.errors)


@dataclass(frozen=True, eq=False)
class Trials:
    """Try set-ups on the same samples."""

    samples: Samples
    terms: tuple[str, ...] | None = None
    _bases: dict[int, tuple[tuple[Link, ...], BaseModel]] = field(default_factory=dict)
    _regressors: dict[tuple[object, ...], Regressor] = field(default_factory=dict)
    _plans: dict[tuple[object, ...], ColumnPlan] = field(default_factory=dict)
    _links: dict[tuple[object, ...], tuple[Link, ...]] = field(default_factory=dict)

    def equations(self, setup: Setup) -> Equations:
        """Write down the equations of a set-up."""
        regressor = self._regressor(setup)
        samples = self.samples.read(setup.assignment)
        fitted, judged = (
            tuple(samples.torque[rows, joint] for joint, rows in enumerate(chosen))
            for chosen in _chosen(samples)
        )
        return Equations(regressor, fitted, judged)

    def links(
        self, setup: Setup, change: tuple[object, ...], changed: Callable[[], tuple[Link, ...]]
    ) -> tuple[Link, ...]:
        """Give the links of a set-up after a change, the same ones again: what is known of them is kept."""
        self._base(setup.robot)
        key = id(setup.robot.links), *change
        if key not in self._links:
            self._links[key] = changed()
        return self._links[key]

    def outcome(self, equations: Equations) -> Outcome | None:
        """Fit a set-up with its constraints; None where no accurate optimum is found."""
        normal, base = equations.normal, equations.regressor.base
        prior = default_prior(base.model, np.sqrt(normal.squares / normal.rows))
        try:
            solution = solve(Programme(base, normal.system, prior, Bounds(plausible=False)), "clarabel")
        except SolverError:
            return None
        values = base.base_of(solution.standard)
        return Outcome(equations.judged_errors(values), mean_log(normal.errors(values)), normal.bound)

    def bound_of_gravity(self, setup: Setup) -> Callable[[Vector3], float]:
        """Give the bound as a function of gravity in the base frame, m/s2, in which torque is linear.

        Products of the equations are quadratic in it, and are taken once.
        """
        parts = [self._series(setup.with_gravity(way)) for way in np.vstack([np.zeros(3), np.eye(3)])]
        rows = [
            self._of_series(setup, part).fitted
            for part in (parts[0], *(part - parts[0] for part in parts[1:]))
        ]
        present, columns = self.equations(setup), self._plan(setup).columns_of
        size = len(present.regressor.base.kept)
        products = np.array([[crossed(own, other, columns, size) for other in rows] for own in rows])
        moments = np.array([towards(own, present.fitted, columns, size) for own in rows])

        def bound(gravity: Vector3) -> float:
            ways = np.append(1.0, gravity)
            whole = np.tensordot(np.outer(ways, ways), products, axes=2)
            return Normal(whole, np.tensordot(ways, moments, axes=1), *present.sizes).bound

        return bound

    def _regressor(self, setup: Setup) -> Regressor:
        key = (*self._motion_key(setup), setup.assignment.position)
        if key not in self._regressors:
            self._regressors[key] = self._of_series(setup, self._series(setup))
        return self._regressors[key]

    def _series(self, setup: Setup) -> Series:
        plan, samples = self._plan(setup), self.samples.read(setup.assignment)
        series = plan.series(samples.state)
        for row, (joint, column) in enumerate(plan.entries):
            if plan.model.parameters[plan.columns[column]].symbol == Coulomb.symbol[0]:
                series[row] = samples.direction[:, joint]
        return series

    def _of_series(self, setup: Setup, series: Series) -> Regressor:
        plan, base = self._plan(setup), self._base(setup.robot)
        chosen = _chosen(self.samples.read(setup.assignment))
        fitted, judged = (
            tuple(
                np.ascontiguousarray(series[rows][:, picked].T)
                for rows, picked in zip(plan.rows_of, marks, strict=True)
            )
            for marks in chosen
        )
        return Regressor(replace(base, model=plan.model), plan.columns_of, fitted, judged)

    def _plan(self, setup: Setup) -> ColumnPlan:
        key = self._motion_key(setup)
        if key not in self._plans:
            kept = self._base(setup.robot).kept
            self._plans[key] = ColumnPlan(standard_model(setup.robot, self.terms), kept)
        return self._plans[key]

    def _base(self, robot: RobotModel) -> BaseModel:
        """Group the parameters for any direction of gravity, once per table."""
        if id(robot.links) not in self._bases:
            general = replace(robot, gravity=9.81 * _GENERAL / np.linalg.norm(_GENERAL))
            self._bases[id(robot.links)] = robot.links, base_model(standard_model(general, self.terms))
        return self._bases[id(robot.links)][1]

    def _motion_key(self, setup: Setup) -> tuple[object, ...]:
        self._base(setup.robot)  # keeps the links, so that no other has their identity
        return id(setup.robot.links), tuple(setup.robot.gravity), setup.assignment.time_factor


def _chosen(samples: Samples) -> tuple[tuple[Indices, ...], tuple[Indices, ...]]:
    """Give the rows of every joint that are fitted, and those that judge."""
    return _rows(samples, ~samples.judged), _rows(samples, samples.judged)


def _rows(samples: Samples, wanted: SampleMask) -> tuple[Indices, ...]:
    return tuple(np.flatnonzero(usable & wanted) for usable in samples.usable.T)


def _relative(left: Vector, torque: Vector) -> float:
    whole = float(torque @ torque)
    return float(np.sqrt(left @ left / whole)) if whole > 0.0 else 1.0
