"""Play a robot with springs between motors and links: every flexible joint has two coordinates.

The first coordinates are the links', one per joint; motors of flexible joints follow. A rotor's inertia,
friction and offset belong to the motor, and so does what drives it. Seen from outside, the loop is that of
the motors, which encoders see. Source: Spong, J. Dyn. Sys. Meas. Control 109, 1987.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np

from ...arrays import Indices, JointSeries, JointVector, Matrix, Vector
from ...signals.state import MotionState
from ..control.control_law import ControlLaw, Inputs
from ..mechanism import Mechanism, Springs
from .loop import Loop, LoopState, Played

START_SECONDS: Final = 1.0
"""Length from the first sample on over which the links' first state is fitted, s: three periods of the
slowest mode that is a joint's."""
START_ROUNDS: Final = 2
"""Steps of that fit, by the derivatives of its first: what bends is gravity along the spring's travel."""
OFFSETS: Final = (1e-5, 1e-3)
"""Change of a link's first position (rad or m) and velocity (per s) by which that fit is differentiated."""


@dataclass(frozen=True, eq=False)
class FlexibleLoop:
    """Hold a mechanism with springs and its controller on a clock."""

    mechanism: Mechanism
    law: ControlLaw
    step: float
    """Time between samples, s."""
    substeps: int

    @property
    def _springs(self) -> Springs:
        springs = self.mechanism.springs
        if springs is None:
            raise ValueError("the mechanism has no springs")
        return springs

    @cached_property
    def _motors(self) -> Indices:
        """Give, per joint, the coordinate of its motor."""
        motors = np.arange(self.mechanism.joints)
        joints = self._springs.joints
        motors[joints] = len(motors) + np.arange(len(joints))
        return motors

    @cached_property
    def _inner(self) -> Loop:
        """Give the loop of all coordinates."""
        own, springs = self.mechanism, self._springs
        count, motors = own.joints + len(springs.joints), self._motors
        place = np.zeros((own.joints, count))
        place[np.arange(own.joints), motors] = 1.0
        apart = np.zeros((len(springs.joints), count))
        apart[:, springs.joints] = -np.eye(len(springs.joints))
        apart[:, motors[springs.joints]] = np.eye(len(springs.joints))
        coordinates = replace(
            own,
            inertia=place.T @ own.inertia @ place,
            damping=place.T @ own.damping @ place + (apart.T * springs.damping) @ apart,
            offset=place.T @ own.offset,
            weights=own.weights @ place,
            frictions=np.append(motors, count + np.arange(len(own.robot.couplings)))[own.frictions],
            springs=None,
            stiffness=(apart.T * springs.stiffness) @ apart,
        )
        law = ControlLaw(np.ascontiguousarray(self._wide(self.law.table)), self.law.sampled)
        return Loop(coordinates, law, self.step, self.substeps)

    def _wide(self, series: JointSeries) -> JointSeries:
        """Put series of joints at the motors' coordinates, zeros at those of flexible links."""
        wide = np.zeros((len(series), self.mechanism.joints + len(self._springs.joints)))
        wide[:, self._motors] = series
        return wide

    def start(
        self, state: MotionState, inputs: Inputs, slopes: Matrix | None = None
    ) -> tuple[LoopState, Matrix]:
        """Begin at the first row of a motion, with the links where the torques that follow say they are.

        Two numbers per spring are unknown. They are those with which the controller adds least.

        Parameters
        ----------
        slopes
            Derivatives of what the controller adds by these numbers, of a robot that differs by little.

        Returns
        -------
        tuple[LoopState, Matrix]
            The state, and the derivatives: those given, or those of this robot.
        """
        samples = slice(0, round(START_SECONDS / self.step))
        first = Inputs(inputs.feed_forward[samples], inputs.position[samples], inputs.velocity[samples])
        scale = np.maximum(np.std(first.feed_forward, axis=0), 1e-9)

        def added(unknown: Vector) -> Vector:
            played, _ = self.run(self._begun(state, unknown), first)
            return np.asarray(((first.feed_forward - played.torque) / scale).ravel())

        springs = self._springs
        count = len(springs.joints)
        at = np.zeros(2 * count)
        at[:count] = -self._carried(state, first)[springs.joints] / springs.stiffness
        left = added(at)
        pushes = np.repeat(OFFSETS, count)
        if slopes is None:
            pairs = zip(np.diag(pushes), pushes, strict=True)
            slopes = np.column_stack([(added(at + push) - left) / size for push, size in pairs])
        for number in range(START_ROUNDS):
            left = added(at) if number else left
            at -= pushes * np.linalg.lstsq(slopes * pushes, left, rcond=None)[0]
        return self._begun(state, at), slopes

    def _carried(self, state: MotionState, inputs: Inputs) -> JointVector:
        """Give about what the springs carry at the first row: torque less what the motors take."""
        own = self.mechanism
        torque = inputs.feed_forward[0] - own.inertia @ state.acceleration[0] - own.offset
        return np.asarray(torque - own.damping @ state.velocity[0])

    def _begun(self, state: MotionState, unknown: Vector) -> LoopState:
        """Begin with links that lie so far from their motors, and move so much faster."""
        joints = self._springs.joints
        apart, faster = np.split(unknown, 2)

        def of(series: JointSeries, change: Vector) -> JointSeries:
            wide = self._wide(series[:1])
            wide[0, joints] = series[0, joints] + change
            return wide

        still = np.zeros(len(joints))
        wide = MotionState(
            of(state.position, apart),
            of(state.velocity, faster),
            of(state.acceleration, still),
            None if state.time is None else state.time[:1],
        )
        return self._inner.start(wide)

    def run(self, state: LoopState, inputs: Inputs) -> tuple[Played, LoopState]:
        """Play the samples of the inputs; gives the rows of the motors, and the state to go on from.

        Raises
        ------
        SolverError
            If the motion diverges, or the mass matrix is not positive definite.
        """
        wide = (self._wide(part) for part in (inputs.feed_forward, inputs.position, inputs.velocity))
        played, later = self._inner.run(state, Inputs(*wide))
        return Played(self._seen(played.state), played.torque[:, self._motors]), later

    def _seen(self, state: MotionState) -> MotionState:
        """Give the motion of motors, with that of the links."""
        motors, joints = self._motors, self.mechanism.joints
        share = state.friction_share
        couplings = np.arange(joints + len(self._springs.joints), 0 if share is None else share.shape[1])
        return MotionState(
            state.position[:, motors],
            state.velocity[:, motors],
            state.acceleration[:, motors],
            state.time,
            friction_share=None if share is None else share[:, np.append(motors, couplings)],
            link_position=state.position[:, :joints],
            link_velocity=state.velocity[:, :joints],
            link_acceleration=state.acceleration[:, :joints],
        )
