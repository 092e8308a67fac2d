"""Play a controlled robot through the samples of a log: sample after sample in one compiled loop, in pieces.

A row holds position, velocity and acceleration at its instant, the friction's share of its level, and the
torque that all these take: the inverse dynamics hold to rounding at every row, also where friction holds a
joint. Velocities stand half a step beside positions. A row's velocity is the mean of those before and after
it, and the damping of joints and controller acts on that mean: it is taken implicitly, so that no damping
makes the scheme unstable (above 2 M / h a speed that is off alternates while it decays), and positions are of
order two. Only the bias is taken at the velocity that the last acceleration foresees: by that, which is of
order two, a row's torque differs from the controller's. A sampled controller holds its torque, which jumps at
the rows: a row's torque is the mean of what was held before and after. Sources: see `loop_kernel`.
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import FrictionShares, JointSeries, JointVector, SquareMatrix
from ...dynamics.terms.joint_coupling import MissingCoupling
from ...dynamics.terms.payload_change import Payload
from ...errors import OptionError, SolverError
from ...signals.state import MotionState, concatenate_states
from ..control.control_law import ControlLaw, Inputs
from ..integrate import FASTEST, failure
from ..mechanism import Mechanism
from . import loop_kernel as rows


@dataclass(frozen=True, eq=False)
class LoopState:
    """Hold the robot and its controller between two samples; what a motion was cut into goes on from it."""

    table: np.ndarray
    """One column per joint; for its rows see `loop_kernel.STATE_ROWS`."""
    held: np.ndarray
    """Torque (N m or N) of every friction of the mechanism."""
    samples: int
    """Samples that have been played."""
    begin: float
    """Instant of the first sample, s."""


@dataclass(frozen=True, eq=False)
class Played:
    """Hold simulated rows: the motion with the shares of friction, and the torque, N m or N."""

    state: MotionState
    torque: JointSeries

    def at(self, samples: slice) -> "Played":
        """Give some of the rows."""
        return Played(self.state.at(samples), self.torque[samples])

    def then(self, later: "Played") -> "Played":
        """Give these rows and those that follow."""
        if not len(self.torque):
            return later
        state = concatenate_states([self.state, later.state])
        return Played(state, np.concatenate([self.torque, later.torque]))


@dataclass(frozen=True, eq=False)
class Loop:
    """Hold a mechanism and its controller on a clock.

    Raises
    ------
    OptionError
        If the mechanism has terms that the loop does not compile, or the clock is none.
    """

    mechanism: Mechanism
    law: ControlLaw
    step: float
    """Time between samples, s."""
    substeps: int = 1
    """Steps of the integration from one sample to the next."""

    def __post_init__(self) -> None:
        """Refuse what is not compiled."""
        if not self.step > 0.0 or self.substeps < 1:
            raise OptionError(
                "the clock of the simulation is not valid",
                evidence={"step": self.step, "substeps": self.substeps},
                remedy="give a positive time between samples and at least one step from each to the next",
            )
        left = not_compiled(self.mechanism)
        if left:
            raise OptionError(
                "the compiled loop does not simulate all terms of the model",
                evidence={"terms": left},
                remedy="simulate with the standard terms only, or replay blocks of the log",
            )

    def start(self, state: MotionState) -> LoopState:
        """Begin at the first row of a motion, whose velocity and acceleration it takes over."""
        position, velocity, acceleration = (
            np.asarray(part[0], dtype=float) for part in (state.position, state.velocity, state.acceleration)
        )
        table = np.zeros((rows.STATE_ROWS, self.mechanism.joints))
        table[rows.POSITION], table[rows.ACCELERATION] = position, acceleration
        table[rows.SPEED] = velocity - 0.5 * self.step / self.substeps * acceleration
        table[rows.EARLIER], table[rows.BEFORE] = (position - back * self.step * velocity for back in (1, 2))
        table[rows.FILTERED] = velocity
        begin = 0.0 if state.time is None else float(state.time[0])
        return LoopState(table, np.zeros(len(self.mechanism.levels)), 0, begin)

    def run(self, state: LoopState, inputs: Inputs) -> tuple[Played, LoopState]:
        """Play the samples of the inputs; gives their rows, and the state from which the next ones go on.

        Raises
        ------
        SolverError
            If the motion diverges, or the mass matrix is not positive definite.
        """
        mechanism = self.mechanism
        given = tuple(
            np.ascontiguousarray(part, dtype=float)
            for part in (inputs.feed_forward, inputs.position, inputs.velocity)
        )
        table, held = state.table.copy(), state.held.copy()
        motion = tuple(np.empty_like(given[0]) for _ in range(4))
        share = np.empty((len(given[0]), len(held)))
        failed = rows.play(
            mechanism.bodies,
            (mechanism.inertia, mechanism.damping, mechanism.weights),
            mechanism.stiffness,
            mechanism.offset,
            mechanism.levels,
            self.law.table,
            given,
            table,
            held,
            motion,
            share,
            self.step,
            self.substeps,
            self.law.sampled,
            state.samples == 0,
        )
        if failed >= 0:
            raise self._failure(table, state.begin + self.step * (state.samples + failed))
        position, velocity, acceleration, torque = motion
        time = state.begin + self.step * np.arange(state.samples, state.samples + len(torque))
        found = MotionState(
            position, velocity, acceleration, time, friction_share=self._shares(velocity, share)
        )
        return Played(found, torque), LoopState(table, held, state.samples + len(torque), state.begin)

    def _shares(self, velocity: JointSeries, share: FrictionShares) -> FrictionShares:
        """Give the shares of all frictions; of one without a level it is the sign of its speed."""
        mechanism = self.mechanism
        joints, couplings = mechanism.joints, mechanism.robot.couplings
        weights = np.zeros((joints + len(couplings), joints))
        weights[:joints] = np.eye(joints)
        for coupling, row in zip(couplings, weights[joints:], strict=True):
            row[[joint - 1 for joint in coupling.joints]] = coupling.weights
        shares = np.sign(velocity @ weights.T)
        shares[:, mechanism.frictions] = share
        return shares

    def _failure(self, table: np.ndarray, time: float) -> SolverError:
        """Say at which joint the motion failed."""
        speed = table[rows.SPEED]
        joint = int(np.argmax(~(np.abs(speed) <= FASTEST)))
        if np.isnan(speed).any():
            joint = _first_weak(self.mechanism.mass_matrices(table[rows.POSITION][None])[0])
        return failure(joint, float(speed[joint]), time)


def not_compiled(mechanism: Mechanism) -> list[str]:
    """Name the terms that the loop does not simulate."""
    parts = (mechanism.others, mechanism.with_memory, mechanism.channel)
    names = [name for part in parts for name in part.names]
    model = mechanism.model
    names += [term.name for term in model.terms if isinstance(term, MissingCoupling)]
    if len(mechanism.phases.bodies) > 1:
        names += [term.name for term in model.terms if isinstance(term, Payload)]
    return names


def _first_weak(mass: SquareMatrix) -> int:
    """Give the first joint with which the mass matrix is not positive definite."""
    pivots: JointVector = np.zeros(len(mass))
    for joint in range(len(mass)):
        pivots[joint] = np.linalg.eigvalsh(mass[: joint + 1, : joint + 1])[0]
    return int(np.argmax(~(pivots > 0.0)))
