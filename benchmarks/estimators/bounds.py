"""Compute what estimates are held against: an oracle that knows the true rows, and the Cramer-Rao bound.

The oracle is weighted least squares on the columns of the motion that the robot really made in this very log,
with the true shares of friction, in the band and at the rows of the product. The bound assumes that reference
and controller are known exactly and that positions and torques are those of the loop without noise, plus
white noise: what noise of encoders does to the motion itself is not in it. Source: Kay, Fundamentals of
Statistical Signal Processing I (1993), ch. 3.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from scipy.linalg import solve_triangular

from benchmarks.estimators.plant import LOG_STEP, Run
from benchmarks.estimators.worlds import World
from veritorque.core.estimate.problem import Problem
from veritorque.core.estimate.system import weighted
from veritorque.core.identification.options import parse_options
from veritorque.core.log.model import JointLog
from veritorque.core.regressor.observe import observe
from veritorque.core.signals.condition import Motion
from veritorque.core.signals.parallel import Tile
from veritorque.core.signals.several import condition_all
from veritorque.core.signals.state import MotionState

CHANGE: Final = 3e-4
"""Change of a parameter by which the engine is differentiated: the torque it takes over that of all."""


@dataclass(frozen=True, eq=False)
class _TrueMotion:
    """Give the tiles of a motion with the true motion in the place of the measured one."""

    motion: Motion
    truth: MotionState

    @property
    def kept(self) -> int:
        """Count the decimated samples."""
        return self.motion.kept

    def tiles(self) -> Iterator[Tile]:
        """Go once through the motion."""
        for tile in self.motion.tiles():
            clock = np.asarray(tile.state.time)
            rows = np.clip(np.rint(clock / LOG_STEP).astype(int), 0, len(self.truth.position) - 1)
            yield replace(tile, state=self.truth.at(rows))


def oracle(own: World, drawn: Run, log: JointLog, options: Mapping[str, object]) -> np.ndarray:
    """Fit the base parameters to the log's torque by the true columns."""
    asked = parse_options(options)
    blocks = asked.validation.blocks
    motions = condition_all((log,), own.plant.arm.robot, asked.filter, blocks=blocks)
    problem = Problem(own.base, motions, asked.validation.chosen(1))
    seen = observe(problem.plan, (_TrueMotion(motions[0], drawn.state),), problem.held_out)
    factors = seen.joint_factors(seen.parts(problem.held_out)[0])
    return weighted(factors, seen.columns_of, len(own.base.kept)).solved()


@dataclass(frozen=True, eq=False)
class Information:
    """Hold triangles whose products are the information of positions (1/rad2) and torques (1/(N m)2)."""

    position: np.ndarray
    torque: np.ndarray

    def deviations(self, noise: tuple[float, float]) -> np.ndarray:
        """Give the least standard deviation of every base parameter at a noise (deg, N m)."""
        rows = np.vstack([self.position / np.deg2rad(noise[0]), self.torque / noise[1]])
        scale = np.linalg.norm(rows, axis=0)
        triangle = np.linalg.qr(rows / scale, mode="r")
        answer = solve_triangular(triangle, np.eye(len(scale)))
        return np.asarray(np.linalg.norm(answer, axis=1) / scale)


def information(own: World) -> Information:
    """Differentiate the engine's own motion by every base parameter, in the closed loop."""
    known = own.plant.run(own.motion, own.seconds)
    torque = np.linalg.norm(own.triangle @ own.truth)
    sizes = np.linalg.norm(own.triangle, axis=0)
    columns = [
        _derivative(own, known, kept, CHANGE * torque / size)
        for kept, size in zip(own.base.kept, sizes, strict=True)
    ]
    position, effort = (np.column_stack([column[part] for column in columns]) for part in (0, 1))
    return Information(np.linalg.qr(position, mode="r"), np.linalg.qr(effort, mode="r"))


def _derivative(own: World, known: Run, kept: int, change: float) -> tuple[np.ndarray, np.ndarray]:
    """Give what positions and torques change by, per unit of one parameter."""
    standard = own.standard.copy()
    standard[kept] += change
    moved = own.plant.changed(standard, own.parameters).run(own.motion, own.seconds)
    return (
        (moved.state.position - known.state.position).ravel() / change,
        (moved.torque - known.torque).ravel() / change,
    )
