"""Make a world of the bench: an arm in a loop with a friction truth on a motion, and its noisy logs.

Motion, noise and start have seeds of their own. The truth is known in base parameters, and errors are those
of the torque along a motion that is in no log, without noise, by its true columns.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import product
from typing import Final

import numpy as np

from benchmarks.estimators.arms import ARMS, driven
from benchmarks.estimators.loops import LOOPS, loop_of
from benchmarks.estimators.motions import BASE_HZ, Reference, draw_reference
from benchmarks.estimators.plant import LOG_STEP, Plant, Run, standard_of
from veritorque.core.dynamics.model import DynamicModel, standard_model
from veritorque.core.log.model import JointLog
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.reduction.base import BaseModel, base_model
from veritorque.core.regressor.columns import ColumnPlan, dense

SECONDS: Final = 10.0
MOTION_SEED, UNSEEN_SEED, NOISE_SEED, START_SEED = 1, 2, 3, 4
START_SHARE: Final = 0.15
"""Largest relative error of the parameters that a failed run counts with: BIRDy's starts lie within it."""
THIN: Final = 5
"""One row in so many of the unseen motion counts."""
FRICTIONS: Final = ("coulomb", "presliding")
NOISES: Final[Mapping[str, tuple[float, float]]] = {
    "1e-4/.05": (1e-4, 0.05),
    "1e-3/.05": (1e-3, 0.05),
    "1e-2/.05": (1e-2, 0.05),
    "1e-3/.1": (1e-3, 0.1),
    "1e-2/.1": (1e-2, 0.1),
    "1e-2/.5": (1e-2, 0.5),
    "0.1/.5": (0.1, 0.5),
}
"""RMS noise of encoders (deg) and of torques (N m): BIRDy's five, and two with more."""
WORLDS: Final = tuple("-".join(parts) for parts in product(ARMS, LOOPS, FRICTIONS, BASE_HZ))


@dataclass(frozen=True, eq=False)
class World:
    """Hold a world with its reference motions."""

    name: str
    plant: Plant
    motion: Reference
    unseen: Reference
    seconds: float
    references: bool
    """Whether its logs show what the controller was given and asked for."""

    @cached_property
    def model(self) -> DynamicModel:
        """Give the model that is identified: Coulomb friction, whatever the truth is."""
        return standard_model(self.plant.arm.robot)

    @cached_property
    def base(self) -> BaseModel:
        """Give its base parameters."""
        return base_model(self.model)

    @cached_property
    def parameters(self) -> tuple[str, ...]:
        """Name the standard parameters."""
        return tuple(parameter.name for parameter in self.model.parameters)

    @cached_property
    def standard(self) -> np.ndarray:
        """Give the true standard parameters."""
        return standard_of(self.plant.arm, self.parameters)

    @cached_property
    def truth(self) -> np.ndarray:
        """Give the true base parameters."""
        return self.base.base_of(self.standard)

    @cached_property
    def friction(self) -> np.ndarray:
        """Mark the base parameters of friction and offsets."""
        symbols = [self.base.parameter(row).symbol for row in range(len(self.base.kept))]
        return np.array([symbol in {"FV", "FC", "OFF"} for symbol in symbols])

    @cached_property
    def triangle(self) -> np.ndarray:
        """Give the triangular factor of the true columns along the unseen motion."""
        run = self.plant.run(self.unseen, self.seconds)
        state = run.state.at(slice(None, None, THIN))
        return np.asarray(np.linalg.qr(dense(self.plan, state), mode="r"))

    @property
    def plan(self) -> ColumnPlan:
        """Choose the columns of the base parameters."""
        return ColumnPlan(self.model, self.base.kept)

    def drawn(self, noise: tuple[float, float], run: int) -> Run:
        """Simulate a log with noise of the encoders."""
        return self.plant.run(self.motion, self.seconds, np.deg2rad(noise[0]), _seed(run, 0))

    def log(self, drawn: Run, noise: tuple[float, float], run: int) -> JointLog:
        """Write a simulated log with noise of the torques."""
        rng = np.random.default_rng(_seed(run, 1))
        torque = drawn.torque + noise[1] * rng.normal(size=drawn.torque.shape)
        channels = {}
        if self.references:
            channels = {
                "position_ref": drawn.position_ref,
                "velocity_ref": drawn.velocity_ref,
                "command": drawn.command,
            }
            if self.plant.loop.feeds:
                channels["torque_ref"] = drawn.feed_forward
        return log_from_arrays(f"{self.name}-{run}", drawn.time, drawn.seen, torque, **channels)


@cache
def world(name: str, seconds: float = SECONDS) -> World:
    """Make a world by its name, such as ``tx40-L1-coulomb-slow``."""
    arm, loop, friction, kind = name.split("-")
    own = driven(arm)
    plant = Plant(own.arm, loop_of(loop, own), presliding=friction == "presliding")
    motion, unseen = (draw_reference(own.arm, kind, seed, seconds) for seed in (MOTION_SEED, UNSEEN_SEED))
    references = round(plant.loop.cycle / LOG_STEP) == 1
    return World(name, plant, motion, unseen, seconds, references)


def _seed(run: int, part: int) -> int:
    return int(np.random.SeedSequence([NOISE_SEED, run, part]).generate_state(1)[0])
