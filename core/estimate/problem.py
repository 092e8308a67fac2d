"""State what is to be fitted to which motions, and hold its equations as estimators take them."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ..arrays import BaseParameters, BlockKey, Indices, JointMarks, JointVector, Parameters
from ..errors import ExcitationError
from ..reduction.base import BaseModel
from ..regressor.column_noise import acceleration_columns, noise_products
from ..regressor.columns import ColumnPlan
from ..regressor.factor import Factor, Weigh
from ..regressor.memory import LaggedProducts
from ..regressor.observe import Observation, observe, torque_scales
from ..regressor.prewhitened import PrewhitenedRows, predictors
from ..regressor.rows import InstrumentedRows, RowSource
from ..regressor.whitened import WhitenedRows
from ..robot.model import Parameter, RobotModel
from ..signals.condition import Motion
from ..signals.filtered_noise import acceleration_variance
from .compensation import Compensated
from .gaussian_prior import GaussianPrior
from .kalman.filter_start import FilterStart
from .kalman.innovations import Innovations, Track
from .methods.method import TORQUE, Equations
from .options import KalmanOptions
from .reversals import reversal_weights
from .simulator import SimulationSetup, Simulator
from .system import INSTRUMENTAL, LEAST_SQUARES, Criterion, ordinary, weighted

CHANGE = 1e-4
"""Change of a parameter by which simulations are differentiated: the torque it takes over that of all."""
MOSTLY_TURNING = 0.6
"""Share of a joint's rows beside reversals above which they cannot be left out: a pendulum that swings freely
has two thirds, and a noisy arm up to half."""
LEAST_TORQUE_NOISE = 0.01
"""Share of a residual's power that noise of the torque has at least."""


@dataclass(frozen=True, eq=False)
class Problem:
    """Hold a model to be fitted, the conditioned logs, and what is known otherwise."""

    base: BaseModel
    """The model and its base parameters."""
    motions: tuple[Motion, ...]
    held_out: frozenset[BlockKey]
    """Blocks of the motions that no fit sees."""
    sizes: Mapping[str, float] = field(default_factory=dict)
    """By name, what counts as one unit of deviation of parameters that the standard model has not."""
    prior: GaussianPrior | None = None
    """Normal prior of the base parameters; None for none."""

    @cached_property
    def plan(self) -> ColumnPlan:
        """Choose the columns of the base parameters."""
        return ColumnPlan(self.base.model, self.base.kept)

    def observed(
        self,
        progress: Callable[[float], None] | None = None,
        weigh: Weigh | None = None,
        rows: RowSource | None = None,
    ) -> Observation:
        """Pass over the motions once, with rows weighted as asked, or with others than the measured ones."""
        return observe(self.plan, self.motions, self.held_out, progress=progress, weigh=weigh, rows=rows)


@dataclass(frozen=True, eq=False)
class ObservedProblem:
    """Hold a problem's equations of one pass over the motions: the `FitData` of all estimators."""

    problem: Problem
    observation: Observation
    robust: bool = False
    weigh_reversals: bool = True
    """Whether rows beside a reversal are weighted by their own noise."""
    weights: JointVector | None = None
    """Weight of these rows per joint; None while it is not chosen, and for one."""
    simulation: SimulationSetup = field(default_factory=SimulationSetup)
    """How the motions are simulated, where columns of simulated motion are asked for."""
    criterion: Criterion = LEAST_SQUARES
    """How the factors become equations."""
    kalman: KalmanOptions = field(default_factory=KalmanOptions)
    """What a Kalman filter assumes."""

    @property
    def size(self) -> int:
        """Count the base parameters."""
        return len(self.problem.plan.columns)

    @property
    def columns_of(self) -> tuple[Indices, ...]:
        """Give, per joint, the base parameters that its factors run over."""
        return self.observation.columns_of

    @cached_property
    def fitted(self) -> tuple[int, ...]:
        """Give the indices of the fitted blocks."""
        return self.observation.parts(self.problem.held_out)[0]

    @property
    def block_factors(self) -> tuple[tuple[Factor, ...], ...]:
        """Give the joints' factors of every fitted block."""
        return tuple(
            self.observation.blocks[index].discounted(self.reversal_weights) for index in self.fitted
        )

    @cached_property
    def factors(self) -> tuple[Factor, ...]:
        """Merge the factors of the fitted blocks, one per joint."""
        parts = zip(*self._groups, self.reversal_weights, strict=True)
        return tuple(moving.merged(turning.scaled(float(weight))) for moving, turning, weight in parts)

    @property
    def _groups(self) -> tuple[tuple[Factor, ...], tuple[Factor, ...]]:
        seen = self.observation
        return seen.moving_factors(self.fitted), seen.turning_factors(self.fitted)

    @property
    def reversal_weights(self) -> JointVector:
        """Give, per joint, the weight of its rows beside a reversal."""
        return np.ones(len(self.columns_of)) if self.weights is None else self.weights

    def discounted(self) -> "ObservedProblem":
        """Weigh the rows beside reversals by their own noise, unless that is not wanted."""
        if not self.weigh_reversals:
            return self
        return replace(self, weights=reversal_weights(*self._groups, self.columns_of, self.size))

    @property
    def memory(self) -> tuple[LaggedProducts, ...]:
        """Give, per joint, the lagged products of the fitted rows."""
        seen = self.observation
        parts = zip(seen.turning_memory, seen.memory, self.reversal_weights, strict=True)
        return tuple(turning.discounted(whole, float(weight)) for turning, whole, weight in parts)

    def weighted(self, weigh: Weigh) -> "ObservedProblem":
        """Pass over the motions again with every row weighted."""
        return replace(self, observation=self.problem.observed(weigh=weigh))

    def simulated(self, at: Parameters) -> "ObservedProblem":
        """Take the columns of the motion that a robot of these parameters makes.

        Where springs move the links, these columns are no derivatives near a mode: the derivatives are taken.
        """
        problem = self.problem
        if any(term.shapes_motion for term in problem.base.model.terms):
            return self.differentiated(at, TORQUE)
        moved = observe(problem.plan, self._simulator.moved(at), held_out=problem.held_out)
        return replace(self, observation=moved)

    def instrumented(self, at: Parameters) -> "ObservedProblem":
        """Put those columns before the measured ones, as instruments."""
        rows = InstrumentedRows(self.problem.plan, self._simulator.moved(at))
        return replace(self, observation=self.problem.observed(rows=rows), criterion=INSTRUMENTAL)

    def differentiated(self, at: Parameters, output: str) -> "ObservedProblem":
        """Take the derivatives of a simulated output, and what the log shows beyond it."""
        measured = weighted(self.factors, self.columns_of, self.size)
        sizes = np.linalg.norm(measured.triangle, axis=0)
        changes = CHANGE * np.linalg.norm(measured.target) / np.where(sizes > 0.0, sizes, sizes.max())
        rows = self._simulator.differentiated(at, output, changes)
        return replace(self, observation=self.problem.observed(rows=rows))

    def prewhitened(self, at: Parameters) -> "ObservedProblem":
        """Put simulated columns first, and take out of every row what those before it tell of its error.

        A joint's rows beside reversals err otherwise, and are left out.
        """
        problem, weights = self.problem, 1.0 - self._drops_turning
        base, moving = problem.base.base_of(at), replace(self, weights=weights)
        known = tuple(
            predictors(products.autocovariance(base[place]))
            for products, place in zip(moving.memory, self.columns_of, strict=True)
        )
        plain = InstrumentedRows(problem.plan, self._simulator.moved(at))
        rows = PrewhitenedRows(plain, known, self._drops_turning)
        return replace(moving, observation=problem.observed(rows=rows), criterion=INSTRUMENTAL)

    def compensated(self) -> "ObservedProblem":
        """Take what noise of positions adds to the products of columns out of them.

        The sign of a noisy speed has no linear model: a joint's rows beside reversals are left out.
        """
        plan, variance = self.problem.plan, acceleration_variance(self.problem.motions)
        added = noise_products(plan, acceleration_columns(plan, self.observation.positions), variance)
        products, weights = np.zeros((len(added), self.size, self.size)), 1.0 - self._drops_turning
        parts = zip(added, self.columns_of, *self._groups, strict=True)
        for joint, (own, place, moving, turning) in enumerate(parts):
            products[joint][np.ix_(place, place)] = own * (moving.rows + weights[joint] * turning.rows)
        return replace(self, weights=weights, criterion=Compensated(products))

    @property
    def _drops_turning(self) -> JointMarks:
        """Mark the joints that have enough rows without those beside reversals."""
        moving, turning = (np.array([factor.rows for factor in group]) for group in self._groups)
        return np.asarray(turning <= MOSTLY_TURNING * (moving + turning))

    def whitened(self, base: BaseParameters, noise: JointVector) -> "ObservedProblem":
        """Combine the joints' rows by the covariance that noise of positions gives them; compensate too."""
        problem, plain, drops = self.problem, self.problem.plan, self._drops_turning
        variance = acceleration_variance(problem.motions)
        added = noise_products(plain, acceleration_columns(plain, self.observation.positions), variance)
        taken = [base[place] @ own @ base[place] for own, place in zip(added, plain.columns_of, strict=True)]
        torque = np.sqrt(np.maximum(noise**2 - np.array(taken), LEAST_TORQUE_NOISE * noise**2))
        rows = WhitenedRows(plain, base, torque, np.sqrt(variance), noise, drops)
        products = np.zeros((len(noise), self.size, self.size))
        for number, motion in enumerate(problem.motions):
            held = [block for log, block in problem.held_out if log == number]
            for tile in motion.tiles():
                products += rows.noise_products(tile, ~np.isin(tile.block, held))
        return replace(
            self,
            observation=problem.observed(rows=rows),
            weights=1.0 - drops,
            criterion=Compensated(products),
        )

    def filtered(self, at: Parameters, *, unscented: bool) -> tuple[Equations, Innovations]:
        """Take what a Kalman filter learns of the parameters that starts at these."""
        from .kalman.filtering import follow  # compiled for some ten seconds, hence only for who filters
        from .kalman.followed import FollowedProblem

        start, problem = self._filter_start(at, unscented=unscented), self.problem
        own = FollowedProblem(follow(start, problem.motions, problem.held_out))
        return own, own.innovations

    def tracked(self, at: Parameters, *, unscented: bool) -> Track:
        """Follow parameters over time that drift by the share of their values that was asked for."""
        from .kalman.filtering import follow  # compiled, too

        start, problem = self._filter_start(at, unscented=unscented), self.problem
        drift = self.kalman.drift * np.abs(start.values)
        return follow(start, problem.motions, problem.held_out, drift).track

    def _filter_start(self, at: Parameters, *, unscented: bool) -> FilterStart:
        own = self.simulated(at).discounted()
        return FilterStart(
            self.problem.base,
            at,
            weighted(own.factors, own.columns_of, own.size),
            torque_scales(self.observation, self.fitted),
            self.simulation.options.substeps,
            self.kalman,
            unscented,
        )

    def position_rms(self, at: Parameters) -> JointVector:
        """Give the RMS of a robot's simulated less the measured positions at usable samples, rad or m."""
        squares, counts = np.zeros((2, len(self.columns_of)))
        for motion, other in zip(self.problem.motions, self._simulator.moved(at), strict=True):
            for tile, moved in zip(motion.tiles(), other.tiles(), strict=True):
                at_kept = tile.first + tile.parallel.decimation * np.arange(len(tile.time))
                apart = (moved.state.position - tile.state.position)[at_kept]
                squares += np.sum(moved.usable * apart**2, axis=0)
                counts += moved.usable.sum(axis=0)
        return np.asarray(np.sqrt(squares / np.maximum(counts, 1.0)))

    @property
    def _simulator(self) -> Simulator:
        problem = self.problem
        return Simulator(problem.base, problem.motions, self.simulation, self.observation.positions)

    def check_excitation(self) -> None:
        """Refuse a motion in which no inertia takes any torque: every joint keeps its speed.

        Raises
        ------
        ExcitationError
            If no inertia shows, or there are fewer usable equations than parameters.
        """
        plan = self.problem.plan
        parameters = [plan.model.parameters[column] for column in plan.columns]
        norms = np.linalg.norm(ordinary(self.factors, self.columns_of, self.size).triangle, axis=0)
        idle = [parameter.name for parameter, norm in zip(parameters, norms, strict=True) if norm == 0.0]
        inertias = _moments_of_inertia(parameters, plan.model.robot)
        if inertias and inertias <= set(idle):
            raise ExcitationError(
                "no joint changes its speed, so that no inertia shows in the torque",
                evidence={"parameters_not_excited": idle},
                remedy="record a motion in which every joint speeds up, slows down and turns round",
            )


def _moments_of_inertia(parameters: Sequence[Parameter], robot: RobotModel) -> set[str]:
    """Name those that motion may show: none where all joints slide, though their bodies have some."""
    turns = any(link.kind == "revolute" for link in robot.links)
    return {parameter.name for parameter in parameters if turns and parameter.unit == "kg m2"}
