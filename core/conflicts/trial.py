"""Try a set-up: fit the standard model with its constraints to some instants, and judge it on others.

Signs and exchanged channels hardly change plain least squares. They change whether a body is possible, so
that only the feasible fit tells them. The instants are few and the question is coarse, so that the equations
are kept as products, which set-ups with the same motion share.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ..arrays import JointMarks, JointVector, Parameters, SampleMask, Series
from ..dynamics.model import DynamicModel, standard_model
from ..dynamics.term import Term
from ..dynamics.terms.coulomb import Coulomb
from ..dynamics.terms.offset import Offset
from ..errors import SolverError
from ..estimate.constraints import Bounds, default_prior
from ..estimate.programme import Programme
from ..estimate.with_clarabel import solve_with_clarabel
from ..reduction.base import BaseModel, base_model
from ..regressor.columns import ColumnPlan
from ..robot.model import Link, RobotModel
from .equations import Equations, Regressor, Rows
from .family import RegressorFamily, family
from .normal import condensed
from .reduced import mean_log
from .samples import Samples
from .setup import Setup
from .thresholds import TRIAL

_GENERAL = np.array([0.37, -0.54, -0.75])
"""A direction of gravity along no axis: base parameters for it span those of any other direction."""
_STEP = 0.3
"""Change of a length, m, on either side, from which the coefficients of a quadratic are taken."""


@dataclass(frozen=True, eq=False)
class Outcome:
    """Hold how well a set-up predicts."""

    errors: JointVector
    """RMS residual over RMS torque per joint, on the rows that judge."""
    unpredicted: JointVector
    """The same over the torque's variation."""
    fitted: float
    """Mean logarithm of the same on the rows that were fitted."""
    bound: float
    """What it would be there without constraints."""
    offsets: JointVector
    """Torque offset over RMS torque per joint, both without sign."""

    @property
    def score(self) -> float:
        """Give the mean logarithm of the joints' errors."""
        return float(mean_log(self.errors))

    def is_like(self, other: "Outcome") -> bool:
        """Tell whether two set-ups predict alike on every joint, with constraints and without."""
        own, others = ([*outcome.errors, np.exp(outcome.bound)] for outcome in (self, other))
        return bool(np.allclose(own, others, rtol=TRIAL.alike, atol=TRIAL.least_error))


@dataclass(frozen=True, eq=False)
class _Grouped:
    """Hold the base parameters of a table, and the columns that they are of."""

    base: BaseModel
    plan: ColumnPlan


@dataclass(frozen=True, eq=False)
class Trials:
    """Try set-ups on the same samples."""

    samples: Samples
    terms: tuple[str, ...] | None = None
    beside: tuple[Term, ...] = ()
    """Terms beside those of the standard model."""
    _bases: dict[tuple[Link, ...], _Grouped] = field(default_factory=dict)
    _regressors: dict[tuple[object, ...], Regressor] = field(default_factory=dict)
    _outcomes: dict[tuple[object, ...], Outcome | None] = field(default_factory=dict)
    _families: dict[tuple[object, ...], RegressorFamily] = field(default_factory=dict)
    _links: dict[tuple[object, ...], tuple[Link, ...]] = field(default_factory=dict)

    @cached_property
    def _fitted(self) -> Samples:
        return self.samples.at(~self.samples.judged)

    @cached_property
    def _judged(self) -> Samples:
        return self.samples.at(self.samples.judged)

    def judged_by(self, judged: SampleMask) -> "Trials":
        """Give trials on the same samples that other rows judge."""
        samples = replace(self.samples, judged=judged)
        return Trials(samples, self.terms, self.beside, _bases=self._bases, _links=self._links)

    def equations(self, setup: Setup) -> Equations:
        """Write down the equations of a set-up."""
        key = _motion_key(setup)
        if key not in self._regressors:
            self._regressors[key] = self._regressor(setup)
        return Equations(self._regressors[key], setup.assignment.torque)

    def bound(self, setup: Setup) -> float:
        """Give what least squares leaves under a set-up that is tried in passing: nothing of it is kept."""
        products = self._regressor(setup).products
        return float(products.read(setup.assignment.torque).bound)

    def moves(self, setup: Setup) -> JointMarks:
        """Mark the joints that have equations: the others stand all the time."""
        return np.asarray(self.samples.moved(setup.assignment).usable.any(axis=0))

    def outcome(self, setup: Setup) -> Outcome | None:
        """Fit a set-up with its constraints, once; None without an accurate optimum, or with too few rows."""
        key = *_motion_key(setup), setup.assignment.torque
        if key not in self._outcomes:
            self._outcomes[key] = self._fit(self.equations(setup))
        return self._outcomes[key]

    def _fit(self, equations: Equations) -> Outcome | None:
        reduced, base, rows = equations.reduced, equations.regressor.base, equations.regressor.fitted
        if reduced.rows.sum() <= len(base.kept):
            return None
        columns_of = equations.regressor.plan.columns_of
        system = condensed(rows.columns, columns_of, rows.torque(equations.channels), reduced.noise)
        of_torque = replace(base.model, robot=replace(base.model.robot, prior=None))
        prior = default_prior(of_torque, np.sqrt(reduced.torques / reduced.rows))
        try:
            solution = solve_with_clarabel(
                Programme(base, system, prior, Bounds(plausible=False)), coarse=True
            )
        except SolverError:
            return None
        values = base.base_of(solution.standard)
        fitted = float(mean_log(equations.errors(values, judged=False)))
        errors, unpredicted = equations.errors(values, judged=True), equations.unpredicted(values)
        squares = reduced.rows * _offsets(base.model, solution.standard) ** 2
        offsets = np.sqrt(squares / np.where(reduced.torques > 0.0, reduced.torques, np.inf))
        return Outcome(errors, unpredicted, fitted, float(reduced.bound), offsets)

    def under_gravity(self, setup: Setup) -> Callable[[np.ndarray], np.ndarray]:
        """Give the bound as a function of gravity in the base frame, m/s2, in which torque is linear."""
        key = _motion_key(setup.with_gravity(np.zeros(3)))
        if key not in self._families:
            self._families[key] = self._gravities(setup)
        shared = self._families[key]

        def bound(gravity: np.ndarray) -> np.ndarray:
            coordinates = np.concatenate([np.ones_like(gravity[..., :1]), gravity], axis=-1)
            return shared.at(coordinates).read(setup.assignment.torque).bound

        return bound

    def _gravities(self, setup: Setup) -> RegressorFamily:
        plan = self._base(setup.robot).plan
        directions = np.vstack([np.zeros(3), np.eye(3)])
        none, *others = (self._rows(plan, setup.with_gravity(direction)) for direction in directions)
        parts = [none.columns, *(_difference(own, none) for own in others)]
        return family(parts, plan.columns_of, none.measured)

    def along_length(
        self, setup: Setup, general: tuple[Link, ...], changed: Callable[[float], tuple[Link, ...]]
    ) -> Callable[[np.ndarray], np.ndarray]:
        """Give the bound as a function of a length's error, m, in which torque is quadratic.

        Base parameters for lengths that are all `general` span those of any others.
        """
        less, more = (setup.with_links(changed(change)) for change in (-_STEP, _STEP))
        key = *_motion_key(setup), more.robot.links
        if key not in self._families:
            self._families[key] = self._lengths(less, setup, more, general)
        shared = self._families[key]

        def bound(errors: np.ndarray) -> np.ndarray:
            coordinates = np.stack([np.ones_like(errors), errors, errors**2], axis=-1)
            return shared.at(coordinates).read(setup.assignment.torque).bound

        return bound

    def _lengths(self, less: Setup, same: Setup, more: Setup, general: tuple[Link, ...]) -> RegressorFamily:
        plan = self._base(replace(same.robot, links=general)).plan
        shorter, present, longer = (self._rows(plan, setup) for setup in (less, same, more))
        slope = [own / (2.0 * _STEP) for own in _difference(longer, shorter)]
        rises = zip(_difference(longer, present), _difference(present, shorter), strict=True)
        curve = [(later - earlier) / (2.0 * _STEP**2) for later, earlier in rises]
        return family([present.columns, slope, curve], plan.columns_of, present.measured)

    def links(
        self, setup: Setup, change: tuple[object, ...], changed: Callable[[], tuple[Link, ...]]
    ) -> tuple[Link, ...]:
        """Give the links of a set-up after a change, the same ones again: what is known of them is kept."""
        key = setup.robot.links, *change
        if key not in self._links:
            self._links[key] = changed()
        return self._links[key]

    def _regressor(self, setup: Setup) -> Regressor:
        grouped = self._base(setup.robot)
        base = replace(grouped.base, model=replace(grouped.base.model, robot=setup.robot))
        fitted = self._rows(grouped.plan, setup)
        return Regressor(base, grouped.plan, fitted, lambda: self._rows(grouped.plan, setup, judged=True))

    def _rows(self, plan: ColumnPlan, setup: Setup, *, judged: bool = False) -> Rows:
        samples = (self._judged if judged else self._fitted).moved(setup.assignment)
        series = plan.series(samples.state, setup.robot)
        for row, (joint, column) in enumerate(plan.entries):
            if plan.model.parameters[plan.columns[column]].symbol == Coulomb.symbol[0]:
                series[row] = samples.direction[:, joint]
        parts = zip(plan.rows_of, samples.usable.T, strict=True)
        return Rows(tuple(series[rows][:, usable] for rows, usable in parts), samples)

    def _base(self, robot: RobotModel) -> _Grouped:
        """Group the parameters for any direction of gravity, once per table."""
        if robot.links not in self._bases:
            general = replace(robot, gravity=9.81 * _GENERAL / np.linalg.norm(_GENERAL))
            model = standard_model(general, self.terms)
            base = base_model(replace(model, terms=(*model.terms, *self.beside)))
            self._bases[robot.links] = _Grouped(base, ColumnPlan(base.model, base.kept))
        return self._bases[robot.links]


def _motion_key(setup: Setup) -> tuple[object, ...]:
    """Tell set-ups of one motion, whose torques alone may differ."""
    assignment = setup.assignment
    return setup.robot.links, tuple(setup.robot.gravity), assignment.position, assignment.time_factor


def _offsets(model: DynamicModel, standard: Parameters) -> JointVector:
    """Give the size of every joint's torque offset, N m or N; zero where the model has none."""
    found = np.zeros(len(model.robot.joints))
    for parameter, value in zip(model.parameters, standard, strict=True):
        if parameter.symbol == Offset.symbol[0]:
            found[parameter.number - 1] = abs(value)
    return found


def _difference(rows: Rows, others: Rows) -> list[Series]:
    return [own - other for own, other in zip(rows.columns, others.columns, strict=True)]
