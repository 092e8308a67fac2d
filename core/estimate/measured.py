"""Hold the conditioned logs that a model is fitted to, and make the weighted equations of a fit from them."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..arrays import BlockKey
from ..dynamics.model import DynamicModel
from ..errors import ExcitationError, OptionError
from ..reduction.base import base_model
from ..regressor.columns import ColumnPlan
from ..regressor.observe import Observation, Weigh, observe
from ..signals.condition import Motion
from .options import EstimateOptions
from .robust import ROUNDS, huber_weights
from .smoothing import chosen_widths, scan_plan, with_candidates
from .system import System, ordinary, stacked, weighted


@dataclass(frozen=True, eq=False)
class Measured:
    """Hold what every pass over the data needs."""

    plan: ColumnPlan
    motions: tuple[Motion, ...]
    held_out: frozenset[BlockKey]

    def observed(
        self, progress: Callable[[float], None] | None = None, weigh: Weigh | None = None
    ) -> Observation:
        """Pass over the data once, weighing rows as asked."""
        return observe(self.plan, self.motions, held_out=self.held_out, progress=progress, weigh=weigh)

    def parts(self, observation: Observation) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """Give the places of the fitted and of the held-out blocks.

        Raises
        ------
        OptionError
            If blocks are held out, but none of them has an instant to judge by.
        """
        fitted: list[int] = []
        held: list[int] = []
        for place, block in enumerate(observation.blocks):
            (held if (block.log, block.number) in self.held_out else fitted).append(place)
        if self.held_out and not any(one.rows for place in held for one in observation.blocks[place].factors):
            raise OptionError(
                "no kept instant lies in the held-out blocks",
                evidence={"instants kept": observation.kept, "blocks held out": len(self.held_out)},
                remedy="keep more instants (smaller decimation, longer log), or hold out longer blocks",
            )
        return tuple(fitted), tuple(held)


def smoothed(
    model: DynamicModel,
    motions: tuple[Motion, ...],
    held_out: frozenset[BlockKey],
    progress: Callable[[float], None],
) -> DynamicModel:
    """Give the model with the widths of its smoothed Coulomb friction chosen from the motion."""
    fitted = {(log, block) for log, motion in enumerate(motions) for block in range(motion.blocks)} - held_out
    speed = np.max([motions[log].recipe.rms_speed for log in sorted({log for log, _ in fitted})], axis=0)
    wide = with_candidates(model, speed)
    data = Measured(scan_plan(wide, base_model(model).kept), motions, held_out)
    observation = data.observed(progress)
    return chosen_widths(observation, model, speed, data.parts(observation)[0])


def weighted_system(
    data: Measured, observation: Observation, options: EstimateOptions
) -> tuple[Observation, System]:
    """Weight the equations as asked, and give the observation they come from: robust fits weigh its rows.

    Raises
    ------
    ExcitationError
        If there are fewer usable equations than parameters, or no inertia shows.
    """
    size = len(data.plan.columns)
    factors = observation.joint_factors(data.parts(observation)[0])
    plain = ordinary(factors, observation.columns_of, size)
    _refuse_without_acceleration(data, plain)
    if options.estimator == "ols":
        return observation, plain
    system = weighted(factors, observation.columns_of, size)
    if options.estimator != "irls" and not options.robust:
        return observation, system
    for _ in range(ROUNDS):
        weigh = huber_weights(system.solved(), observation.columns_of, system.noise)
        observation = data.observed(weigh=weigh)
        factors = observation.joint_factors(data.parts(observation)[0])
        system = stacked(factors, observation.columns_of, size, system.noise)
    return observation, system


def _refuse_without_acceleration(data: Measured, system: System) -> None:
    """Refuse a motion in which no inertia takes any torque: every joint keeps its speed."""
    parameters = [data.plan.model.parameters[column] for column in data.plan.columns]
    norms = np.linalg.norm(system.triangle, axis=0)
    idle = [one for one, norm in zip(parameters, norms, strict=True) if norm == 0.0]
    inertias = [one for one in parameters if one.unit == "kg m2"]
    if inertias and {one.name for one in inertias} <= {one.name for one in idle}:
        raise ExcitationError(
            "no joint changes its speed, so that no inertia shows in the torque",
            evidence={"parameters_not_excited": [one.name for one in idle]},
            remedy="record a motion in which every joint speeds up, slows down and turns round",
        )
