"""Differentiate free motion over short windows, whose initial states are free parameters of their own.

The measured torque alone drives the robot, so that nothing has to be known of a controller. Over a window the
simulated positions drift away by what the model lacks, and by errors of the state that it starts from. The
derivatives by the initial state are known too, and what they span is projected out: least squares over the
rest gives the same parameters as if every initial state were estimated. Sources: Golub & Pereyra, SIAM J.
Numer. Anal. 10, 1973 (variable projection); Ljung, System Identification (1999), ch. 5 (output error).
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...arrays import BaseParameters, Indices, InstantMask, JointMarks, JointSeries, Matrix, Vector
from ...regressor.factor import REGRESSOR, TARGET, FilteredRows, Groups
from ...regressor.rows import Tiled
from ...signals.parallel import Tile
from ...signals.state import MotionState
from ..control.control_law import ControlLaw, Gains, Inputs
from ..integrate import steps_between
from ..mechanism import Mechanism
from .loop import Loop

PUSH = 1e-5
"""Change of an initial position (rad or m) and velocity (per s) by which a window is differentiated."""
FEWEST_INSTANTS = 6
"""Decimated samples in a window at least: its initial state takes two of them, whatever the model."""
RANK_TOLERANCE = 1e-9
"""Share of the largest singular value below which an initial state does not show in a window."""


@dataclass(frozen=True, eq=False)
class FreeWindows:
    """Make rows [J, r + J base] of positions over windows, less what their initial states explain."""

    base: BaseParameters
    """The robot's base parameters."""
    changes: BaseParameters
    """By how much each of them is changed."""
    mechanisms: Sequence[Mechanism]
    """The robot as it is, and with every base parameter changed."""
    seconds: float
    """Length of a window, s."""
    unmeasured: Sequence[JointMarks]
    """Per motion, the joints whose torque was not measured: each robot's own along the measured motion drives
    it."""
    held: Sequence[JointMarks]
    """Per motion, the joints that stand all the time."""
    substeps: int | None = None
    """Steps of the simulation per sample; None for steps of `LONGEST_STEP` at most."""

    @cached_property
    def columns_of(self) -> tuple[Indices, ...]:
        """Give, per joint, the base parameters that its columns belong to: each moves every joint."""
        return (np.arange(len(self.base)),) * self.mechanisms[0].joints

    @cached_property
    def groups(self) -> tuple[Groups, ...]:
        """Give, per joint, what the columns of its rows are."""
        return (((REGRESSOR, len(self.base)), (TARGET, 1)),) * len(self.columns_of)

    def rows(self, number: int, motion: Tiled) -> Iterator[tuple[Tile, list[FilteredRows]]]:
        """Go through a motion tile by tile, and through each window by window."""
        silent, held = self.unmeasured[number], self.held[number]
        robots = [mechanism.holding(held) for mechanism in self.mechanisms]
        for tile in motion.tiles():
            time = np.asarray(tile.state.time)
            step = float(time[-1] - time[0]) / (len(time) - 1)
            length = max(FEWEST_INSTANTS, round(self.seconds / (tile.parallel.decimation * step)))
            begins = range(0, len(tile.time), length)
            table = np.concatenate(
                [self._window(robots, tile, silent, step, slice(at, at + length)) for at in begins]
            )
            yield tile, [(table[:, joint], tile.usable[:, joint]) for joint in range(table.shape[1])]

    def _window(
        self, robots: Sequence[Mechanism], tile: Tile, silent: JointMarks, step: float, chosen: slice
    ) -> np.ndarray:
        """Give a window's rows: instants x joints x columns."""
        at = tile.first + tile.parallel.decimation * np.arange(len(tile.time))[chosen]
        whole, kept = slice(at[0], at[-1] + 1), at - at[0]
        state, torque = tile.state.at(whole), tile.torque[whole]

        def moved(mechanism: Mechanism, start: MotionState) -> JointSeries:
            driving = np.where(silent, mechanism.torque(state), torque) if silent.any() else torque
            return np.asarray(self._moved(mechanism, step, start, driving)[kept])

        own, *changed = (moved(mechanism, state) for mechanism in robots)
        pushed = [moved(robots[0], start) for start in _pushed(state)]
        columns = np.stack([run - own for run in changed], axis=-1) / self.changes
        target = state.position[kept] - own + columns @ self.base
        free = np.stack([run - own for run in pushed], axis=-1) / PUSH
        return _projected(np.concatenate([columns, target[..., None]], axis=-1), free, tile.usable[chosen])

    def _moved(
        self, mechanism: Mechanism, step: float, state: MotionState, torque: JointSeries
    ) -> JointSeries:
        none: Vector = np.zeros(mechanism.joints)
        loop = Loop(
            mechanism, ControlLaw.of_joints(Gains(none, none)), step, steps_between(step, self.substeps)
        )
        played, _ = loop.run(loop.start(state), Inputs(torque, state.position, state.velocity))
        return played.state.position


def _pushed(state: MotionState) -> Iterator[MotionState]:
    """Give the state with every position and every velocity changed."""
    for push in PUSH * np.eye(state.position.shape[1]):
        yield replace(state, position=state.position + push)
        yield replace(state, velocity=state.velocity + push)


def _projected(rows: np.ndarray, free: np.ndarray, usable: InstantMask) -> np.ndarray:
    """Take out of the usable rows what the columns of `free` span; the others are zero."""
    out = np.zeros_like(rows)
    if usable.any():
        basis = _basis(free[usable])
        out[usable] = rows[usable] - basis @ (basis.T @ rows[usable])
    return out


def _basis(columns: Matrix) -> Matrix:
    """Give orthonormal columns that span the same."""
    sizes = np.linalg.norm(columns, axis=0)
    basis, values, _ = np.linalg.svd(columns / np.where(sizes > 0.0, sizes, 1.0), full_matrices=False)
    return np.asarray(basis[:, values > RANK_TOLERANCE * values[0]])
