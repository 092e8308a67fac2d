"""Try a set-up: fit the standard model with its constraints to some instants, and judge it on others.

Signs and exchanged channels hardly change plain least squares. They change whether a body is possible, so
that only the feasible fit tells them. The instants are few and the question is coarse, so that the equations
are kept as products W'W and W'y, which set-ups with the same motion share.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy.linalg import cho_solve, cholesky, solve_triangular

from ..arrays import BaseParameters, Indices, JointVector, Matrix, SampleMask, Series, Vector, Vector3
from ..dynamics.model import standard_model
from ..dynamics.terms.coulomb import Coulomb
from ..errors import SolverError
from ..estimate.constraints import Bounds, default_prior
from ..estimate.estimate import solve
from ..estimate.programme import Programme
from ..estimate.system import System
from ..reduction.base import BaseModel, base_model
from ..regressor.columns import ColumnPlan
from ..robot.model import Link, RobotModel
from .samples import Samples
from .setup import Setup
from .thresholds import TRIAL

_GENERAL = np.array([0.37, -0.54, -0.75])
"""A direction of gravity along no axis: base parameters for it span those of any other direction."""
_RIDGE = 1e-11
"""Added to the diagonal of scaled products, so that they have a Cholesky factor."""
_REWEIGHTINGS = 2


@dataclass(frozen=True, eq=False)
class Regressor:
    """Hold the observation matrix of a set-up's motion, joint by joint."""

    base: BaseModel
    columns_of: tuple[Indices, ...]
    fitted: tuple[Matrix, ...]
    judged: tuple[Matrix, ...]

    @cached_property
    def products(self) -> tuple[Matrix, ...]:
        """Give W'W of the fitted rows per joint."""
        return tuple(rows.T @ rows for rows in self.fitted)


@dataclass(frozen=True, eq=False)
class Equations:
    """Hold a set-up's equations: its regressor, and the torques of the fitted and of the judging rows."""

    regressor: Regressor
    fitted: tuple[Vector, ...]
    judged: tuple[Vector, ...]

    @cached_property
    def moments(self) -> tuple[Vector, ...]:
        """Give W'y of the fitted rows per joint."""
        pairs = zip(self.regressor.fitted, self.fitted, strict=True)
        return tuple(rows.T @ torque for rows, torque in pairs)

    @cached_property
    def squares(self) -> JointVector:
        """Give the squared torque of the fitted rows per joint."""
        return np.array([torque @ torque for torque in self.fitted])

    @cached_property
    def system(self) -> System:
        """Weigh the joints by what least squares leaves of them, in two rounds from equal weights."""
        noise = np.ones(len(self.fitted))
        rows = np.array([max(len(torque), 1) for torque in self.fitted])
        for _ in range(_REWEIGHTINGS):
            left = self._left(_solved(*self._normal(noise)))
            noise = np.sqrt(np.maximum(left, np.maximum(1e-12 * self.squares, 1e-24)) / rows)
        return self._factored(noise, int(rows.sum()))

    @cached_property
    def unconstrained(self) -> BaseParameters:
        """Give the least-squares optimum."""
        return _solved(*self._normal(self.system.noise))

    def fitted_errors(self, base: BaseParameters) -> JointVector:
        """Give the RMS residual over the RMS torque of the fitted rows per joint."""
        return np.asarray(np.sqrt(self._left(base) / np.where(self.squares > 0.0, self.squares, 1.0)))

    def judged_errors(self, base: BaseParameters) -> JointVector:
        """Give the same of the rows that judge; one for a joint without torque."""
        parts = zip(self.regressor.judged, self.regressor.columns_of, self.judged, strict=True)
        pairs = [(rows @ base[columns] - torque, torque) for rows, columns, torque in parts]
        return np.array([_relative(left, torque) for left, torque in pairs])

    def likeliest_factor(self, joint: int) -> float | None:
        """Give the factor of a joint's (from 0) torque at which least squares leaves least of all equations.

        The parameters that other joints share decide it. None where there are none, or it is not positive.
        """
        weights = 1.0 / self.system.noise**2
        moments = np.zeros((len(weights), len(self.regressor.base.kept)))
        for row, (moment, columns) in enumerate(zip(self.moments, self.regressor.columns_of, strict=True)):
            moments[row, columns] = weights[row] * moment
        product, _ = self._normal(self.system.noise)
        own = _solved(product, moments[joint])
        rest = weights[joint] * self.squares[joint] - moments[joint] @ own
        towards = own @ (moments.sum(axis=0) - moments[joint])
        return float(towards / rest) if towards > 0.0 and rest > 0.0 else None

    def _left(self, base: BaseParameters) -> JointVector:
        parts = zip(self.regressor.products, self.moments, self.regressor.columns_of, strict=True)
        fitted = [
            base[columns] @ (product @ base[columns] - 2.0 * moment) for product, moment, columns in parts
        ]
        return np.asarray(np.maximum(self.squares + np.array(fitted), 1e-14 * self.squares))

    def _normal(self, noise: JointVector) -> tuple[Matrix, Vector]:
        size = len(self.regressor.base.kept)
        product, moment = np.zeros((size, size)), np.zeros(size)
        parts = zip(self.regressor.products, self.moments, self.regressor.columns_of, noise, strict=True)
        for own, towards, columns, sigma in parts:
            product[np.ix_(columns, columns)] += own / sigma**2
            moment[columns] += towards / sigma**2
        return product, moment

    def _factored(self, noise: JointVector, rows: int) -> System:
        product, moment = self._normal(noise)
        scale, upper = _cholesky(product)
        target = solve_triangular(upper, moment / scale, trans="T")
        rest = max(float(np.sum(self.squares / noise**2) - target @ target), 0.0)
        return System(upper * scale, target, rest, rows, noise)


@dataclass(frozen=True, eq=False)
class Outcome:
    """Hold how well a set-up predicts."""

    errors: JointVector
    """RMS residual over RMS torque per joint, on the rows that judge."""
    fitted: float
    """Mean logarithm of the same on the rows that were fitted."""

    @property
    def score(self) -> float:
        """Give the mean logarithm of the joints' errors."""
        return mean_log(self.errors)


def mean_log(errors: JointVector) -> float:
    """Give the mean logarithm of errors, none of which counts as smaller than can be told."""
    return float(np.mean(np.log(np.maximum(errors, TRIAL.least_error))))


@dataclass(frozen=True, eq=False)
class Trials:
    """Try set-ups on the same samples."""

    samples: Samples
    terms: tuple[str, ...] | None = None
    _bases: dict[int, tuple[tuple[Link, ...], BaseModel]] = field(default_factory=dict)
    _regressors: dict[tuple[object, ...], Regressor] = field(default_factory=dict)
    _plans: dict[tuple[object, ...], ColumnPlan] = field(default_factory=dict)

    def equations(self, setup: Setup) -> Equations:
        """Write down the equations of a set-up."""
        regressor = self._regressor(setup)
        samples = self.samples.read(setup.assignment)
        fitted, judged = (
            tuple(samples.torque[rows, joint] for joint, rows in enumerate(chosen))
            for chosen in _chosen(samples)
        )
        return Equations(regressor, fitted, judged)

    def bound(self, equations: Equations) -> float:
        """Give the mean logarithm of the errors that least squares leaves: no constraint makes it less."""
        return mean_log(equations.fitted_errors(equations.unconstrained))

    def outcome(self, equations: Equations) -> Outcome | None:
        """Fit a set-up with its constraints; None where no accurate optimum is found."""
        system, base = equations.system, equations.regressor.base
        rows = [max(len(torque), 1) for torque in equations.fitted]
        prior = default_prior(base.model, np.sqrt(equations.squares / rows))
        try:
            solution = solve(Programme(base, system, prior, Bounds(plausible=False)), "clarabel")
        except SolverError:
            return None
        values = base.base_of(solution.standard)
        return Outcome(equations.judged_errors(values), mean_log(equations.fitted_errors(values)))

    def bound_of_gravity(self, setup: Setup) -> Callable[[Vector3], float]:
        """Give the bound as a function of gravity in the base frame, m/s2, in which torque is linear."""
        parts = [self._series(setup.with_gravity(way)) for way in np.vstack([np.zeros(3), np.eye(3)])]
        without, slopes = parts[0], np.array(parts[1:]) - parts[0]
        present = self.equations(setup)

        def bound(gravity: Vector3) -> float:
            series = without + np.tensordot(gravity, slopes, axes=1)
            return self.bound(replace(present, regressor=self._of_series(setup, series)))

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


def _cholesky(product: Matrix) -> tuple[Vector, Matrix]:
    """Give the upper factor of products whose columns were divided by a scale."""
    scale = _norms(product)
    scaled = product / np.outer(scale, scale)
    scaled[np.diag_indices_from(scaled)] += _RIDGE
    return scale, cholesky(scaled)


def _norms(product: Matrix) -> Vector:
    """Give the norms of the columns that products were taken of."""
    norms = np.sqrt(np.diag(product))
    return np.where(norms > 0.0, norms, 1.0)


def _solved(product: Matrix, moment: Vector) -> BaseParameters:
    scale, upper = _cholesky(product)
    return np.asarray(cho_solve((upper, False), moment / scale) / scale)


def _relative(left: Vector, torque: Vector) -> float:
    whole = float(torque @ torque)
    return float(np.sqrt(left @ left / whole)) if whole > 0.0 else 1.0
