"""Move an arm as nature would: MuJoCo's rigid bodies and set-valued friction under a joint controller.

MuJoCo solves bodies and friction at every step; the step itself is a leapfrog (positions at full steps,
velocities at half steps), which makes the logged torque belong to the logged motion to second order. A joint
whose effect splits it has a rotor of its own, on which encoder, friction and drive sit.
"""

from dataclasses import dataclass

import mujoco
import numpy as np
from scipy.ndimage import uniform_filter1d

from tests.plant.controller import Steering
from tests.plant.effects.effect import Effect, Signals, State, overriding
from tests.plant.mechanism import STEPS_PER_SECOND, build
from tests.plant.robots import Arm

ENCODER_STEP = 1e-5
"""One count of an encoder at the joint, rad."""
LOAD_RADIUS = 0.03
"""Radius of gyration of a load, m."""
HARDEST = 0.9999
"""MuJoCo's largest constraint impedance: what is left is the softness of a stuck joint."""


class Plant:
    """Hold an arm with its effects at one instant and advance it step by step.

    `motor` gives the place of every joint's motor among MuJoCo's coordinates.
    """

    def __init__(self, arm: Arm, effects: tuple[Effect, ...], position: np.ndarray) -> None:
        self.split = {one.own: one for one in effects if one.splits}
        self.loads, self.taken = overriding(effects, "carried"), set[int]()
        self.model = build(arm, tuple(self.split), loads=len(self.loads))
        self.data = mujoco.MjData(self.model)
        self.arm, self.step = arm, 1.0 / STEPS_PER_SECOND
        self.links = np.array(list(self.split), dtype=int)
        self.motor = np.arange(arm.joints)
        self.motor[self.links] = arm.joints + np.arange(len(self.links))
        self.drives, self.frictions, self.torques = (
            overriding(effects, place) for place in ("drive", "friction", "torque")
        )
        self._set_drives()
        self.data.qpos[: arm.joints] = position
        self.data.qpos[self.motor] = position
        self._hang()
        self.velocity = np.zeros(self.model.nv)
        self.acceleration = np.zeros(self.model.nv)
        self.level = arm.coulomb.copy()
        self.state = State(self.step, position.copy(), self.level, jacobian=self._jacobian)
        self.tip = self.model.body(arm.robot.links[-1].name).id
        self.sums = np.count_nonzero(arm.motors[:, 2])
        # MuJoCo's arrays stay where they are; asking for them takes longer than most of what is done to them.
        data = self.data
        self.angle, self.rate, self.pushed = data.qpos, data.qvel, data.qfrc_applied
        self.resisted, self.damped, self.accelerated = data.qfrc_constraint, data.qfrc_passive, data.qacc

    def _set_drives(self) -> None:
        model, arm = self.model, self.arm
        for name, value in (("dof_armature", arm.rotor_inertia), ("dof_damping", arm.viscous)):
            getattr(model, name)[self.motor] = value
        model.dof_frictionloss[self.motor] = arm.coulomb
        model.dof_solref[:] = model.tendon_solref_fri[:] = [2.0 * self.step, 1.0]
        model.dof_solimp[:] = model.tendon_solimp_fri[:] = [HARDEST, HARDEST, 0.001, 0.5, 2.0]
        if len(arm.motors):
            model.tendon_armature[:], damping, model.tendon_frictionloss[:] = arm.motors.T
            model.tendon_damping[:] = damping
        mujoco.mj_setConst(model, mujoco.MjData(model))

    def advance(self, command: np.ndarray, gain: np.ndarray, damping: np.ndarray) -> np.ndarray:
        """Take one step under `command` minus gains times state, N m; give the drive's torque."""
        state, motor = self.state, self.motor
        np.add(self.velocity, 0.5 * self.step * self.acceleration, out=self.rate)
        state.position, state.velocity = self.angle[motor], self.rate[motor]
        torque = command - gain * state.position - damping * state.velocity
        applied = torque
        for effect in self.drives:
            applied = effect.drive(applied)
        if self.frictions:
            self._set_level()
        push = applied - self.arm.offset
        for effect in self.torques:
            effect.torque(state, push)
        self.pushed[motor] = push
        for joint, effect in self.split.items():
            self._transmit(joint, effect)
        if self.loads:
            self._take_up()
        mujoco.mj_forward(self.model, self.data)
        self.acceleration = self.accelerated.copy()
        self.velocity = self.velocity + self.step * self.acceleration
        self.angle += self.step * self.velocity
        state.time += self.step
        return torque

    def _hang(self) -> None:
        """Let links that hang on a transmission begin where it carries their weight."""
        data = self.data
        mujoco.mj_forward(self.model, data)
        self.transmitted = {joint: float(data.qfrc_bias[joint]) for joint in self.split}
        for joint, effect in self.split.items():
            data.qpos[joint] -= effect.twist(self.transmitted[joint])

    def _set_level(self) -> None:
        """Give what the gears transmit, which does not turn their rotors, and the friction it makes."""
        motor, state = self.motor, self.state
        moving = self.pushed[motor] + self.resisted[motor] + self.damped[motor]
        state.load = moving - self.arm.rotor_inertia * self.acceleration[motor]
        for coupling, (inertia, _, _) in zip(self.arm.robot.couplings, self.arm.motors, strict=True):
            joints, weights = np.array(coupling.joints) - 1, np.array(coupling.weights)
            state.load[joints] -= inertia * (weights @ self.acceleration[motor[joints]]) * weights
        for joint, transmitted in self.transmitted.items():
            state.load[joint] = transmitted
        self.level[:] = self.arm.coulomb
        for effect in self.frictions:
            effect.friction(state, self.level)
        np.maximum(self.level, 0.0, out=self.level)
        self.model.dof_frictionloss[motor] = self.level

    def _transmit(self, joint: int, effect: Effect) -> None:
        motor = self.motor[joint]
        twist = self.angle[motor] - self.angle[joint]
        torque = effect.transmit(twist, self.rate[motor] - self.rate[joint])
        self.pushed[joint] = torque
        self.pushed[motor] -= torque
        self.transmitted[joint] = torque

    def _take_up(self) -> None:
        for number, effect in enumerate(self.loads):
            body = self.model.body(f"load_{number}").id
            if self.state.time >= effect.time and number not in self.taken:
                self.taken.add(number)
                mass, centre = effect.carried()
                self.model.body_mass[body], self.model.body_ipos[body] = mass, centre
                self.model.body_inertia[body] = mass * LOAD_RADIUS**2
                mujoco.mj_setConst(self.model, mujoco.MjData(self.model))

    def _jacobian(self) -> np.ndarray:
        """Give how the point 10 cm along z and x of the last frame moves with the joints, 3 x joints."""
        jacobian = np.zeros((3, self.model.nv))
        frame = self.data.xmat[self.tip].reshape(3, 3)
        point = self.data.xpos[self.tip] + frame @ np.array([0.1, 0.0, 0.1])
        mujoco.mj_jac(self.model, self.data, jacobian, None, point, self.tip)
        return jacobian[:, : self.arm.joints]

    def direction(self) -> np.ndarray:
        """Give the direction of every joint's own friction in the step just taken, at its beginning."""
        friction = -self.resisted[self.motor]
        if self.sums:
            for coupling, force in zip(self.arm.robot.couplings, self.coupled(), strict=True):
                friction[np.array(coupling.joints) - 1] += force * np.array(coupling.weights)
        if self.frictions:
            self._own_direction(friction)
        else:
            friction /= self.level
        return friction

    def coupled(self) -> np.ndarray:
        """Give the friction forces of coupled motors in the step just taken."""
        return self.data.efc_force[-self.sums :]

    def _own_direction(self, friction: np.ndarray) -> None:
        """Divide friction by its level; an effect that takes the level away tells the direction itself."""
        none = self.level <= 0.0
        if none.any():
            for joint in np.flatnonzero(none):
                own = np.sign(self.state.velocity[joint])
                friction[joint] = self.state.memory.get(f"direction {joint}", own)
        np.divide(friction, self.level, out=friction, where=~none)


@dataclass(frozen=True, eq=False)
class Recording:
    """Hold every step of a simulation, steps x joints in SI; `steps` of them make a row of the log."""

    steps: int
    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    torque: np.ndarray
    direction: np.ndarray
    motor_direction: np.ndarray

    def sampled(self, *, smooth: bool = False) -> Signals:
        """Give the rows of the log.

        Where `smooth`, all but the angles are averaged twice over a row's time before: what rings or jumps
        between the rows then does not pass for something slow. A log is not made so, but an effect's strength
        is judged so.
        """
        ease = self._averaged if smooth else _unchanged
        torque = ease(self.torque)
        every = slice(None, None, self.steps)
        rows = len(torque[every])
        return Signals(
            time=np.arange(rows) * (self.steps / STEPS_PER_SECOND),
            position=self.position[every],
            velocity=ease(self.velocity)[every],
            acceleration=ease(self.acceleration)[every],
            torque=torque[every],
            direction=ease(self.direction)[every],
            motor_direction=ease(self.motor_direction)[every],
            fine_torque=torque,
            steps=self.steps,
            encoder_step=np.full(torque.shape[1], ENCODER_STEP),
            kept=np.arange(rows),
        )

    def _averaged(self, series: np.ndarray) -> np.ndarray:
        for _ in range(2):
            series = uniform_filter1d(series, 2 * (self.steps // 2) + 1, axis=0, mode="nearest")
        return series


def simulate(
    arm: Arm, effects: tuple[Effect, ...], steering: Steering, *, rate_hz: float = 250.0
) -> Recording:
    """Let the arm follow the motion and record every step."""
    plant = Plant(arm, effects, steering.centre)
    steps, joints = steering.command.shape
    position, torque, direction = (np.empty((steps, joints)) for _ in range(3))
    # The plant's own, motors and links, at the half steps before, at the first and at the others.
    velocity, acceleration = np.empty((steps + 1, plant.model.nv)), np.empty((steps, plant.model.nv))
    velocity[0] = plant.velocity
    coupled = np.zeros((steps, len(arm.motors)))
    for step, command in enumerate(steering.command):
        torque[step] = plant.advance(command, steering.gain, steering.damping)
        position[step], direction[step] = plant.state.position, plant.direction()
        velocity[step + 1], acceleration[step] = plant.velocity, plant.acceleration
        if plant.sums:
            coupled[step] = plant.coupled()
    mean = 0.5 * (velocity[:-1] + velocity[1:])[:, plant.motor]
    sums = -coupled / arm.motors[:, 2] if plant.sums else coupled
    series = (position, mean, acceleration[:, plant.motor], torque, direction, sums)
    return Recording(round(STEPS_PER_SECOND / rate_hz), *series)


def _unchanged(series: np.ndarray) -> np.ndarray:
    return series
