"""Move an arm as nature would: MuJoCo's rigid bodies and set-valued friction under a joint controller.

MuJoCo solves bodies and friction at every step; the step itself is a leapfrog (positions at full steps,
velocities at half steps), which makes the logged torque belong to the logged motion to second order. A joint
whose effect splits it has a rotor of its own, on which encoder, friction and drive sit.
"""

from dataclasses import dataclass

import mujoco
import numpy as np
from scipy.ndimage import uniform_filter1d

from core.robot.inertia import mass_properties
from tests.plant.effects.effect import Effect, Signals, State, overriding
from tests.plant.excitation import Excitation
from tests.plant.robots import Arm

STEPS_PER_SECOND = 2000
BANDWIDTH = 2.0 * np.pi * 6.0
"""Bandwidth of the joint controller, rad/s."""
DAMPING_RATIO = 0.8
ENCODER_STEP = 1e-5
"""One count of an encoder at the joint, rad."""
LOAD_RADIUS = 0.03
"""Radius of gyration of a load, m."""
EASE = 0.02
"""Share of a joint's top speed over which the controller's feed-forward of Coulomb friction turns round."""
HARDEST = 0.9999
"""MuJoCo's largest constraint impedance: what is left is the softness of a stuck joint."""


def build(arm: Arm, split: tuple[int, ...] = (), *, loads: int = 0) -> mujoco.MjModel:
    """Build the arm link by link.

    Joints of `split` (from 0) get a rotor of their own, after all links; the last link gets bodies for loads.
    """
    spec = mujoco.MjSpec()
    spec.option.gravity = arm.robot.gravity
    spec.option.timestep = 1.0 / STEPS_PER_SECOND
    spec.option.disableflags = mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_REFSAFE
    spec.compiler.degree = False
    spec.compiler.inertiafromgeom = mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_FALSE
    part = spec.worldbody
    for link, body in zip(arm.robot.links, arm.bodies, strict=True):
        part = part.add_body(name=link.name, pos=link.translation, quat=_quaternion(link.rotation))
        part.add_joint(name=link.name, type=mujoco.mjtJoint.mjJNT_HINGE, axis=[0.0, 0.0, 1.0])
        mass, centre, inertia = mass_properties(body)
        moments, axes = np.linalg.eigh(inertia)
        axes[:, 0] *= np.sign(np.linalg.det(axes))
        part.explicitinertial = True
        part.mass, part.ipos, part.inertia, part.iquat = mass, centre, moments, _quaternion(axes)
    for number in range(loads):
        load = part.add_body(name=f"load_{number}")
        load.explicitinertial = True
        load.mass, load.inertia = 1e-9, [1e-12, 1e-12, 1e-12]
    for joint in split:
        rotor = spec.worldbody.add_body(name=f"rotor_{joint}")
        rotor.add_joint(name=f"rotor_{joint}", type=mujoco.mjtJoint.mjJNT_HINGE, axis=[0.0, 0.0, 1.0])
        rotor.explicitinertial = True
        rotor.mass, rotor.inertia = 1e-9, [1e-12, 1e-12, 1e-12]
    for coupling in arm.robot.couplings:
        tendon = spec.add_tendon(name=coupling.name)
        for joint, weight in zip(coupling.joints, coupling.weights, strict=True):
            tendon.wrap_joint(arm.robot.links[joint - 1].name, weight)
    return spec.compile()


class Plant:
    """Hold an arm with its effects at one instant and advance it step by step.

    `motor` gives the place of every joint's motor among MuJoCo's coordinates.
    """

    def __init__(self, arm: Arm, effects: tuple[Effect, ...], position: np.ndarray) -> None:
        self.split = {one.own: one for one in effects if one.splits}
        self.loads = list(overriding(effects, "carried"))
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
        self.velocity = np.zeros(self.model.nv)
        self.acceleration = np.zeros(self.model.nv)
        self.level = arm.coulomb.copy()
        self.transmitted = dict.fromkeys(self.split, 0.0)
        self.state = State(self.step, position.copy(), self.level, jacobian=self._jacobian)
        self.tip = self.model.body(arm.robot.links[-1].name).id

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
        data, state = self.data, self.state
        data.qvel[:] = self.velocity + 0.5 * self.step * self.acceleration
        state.position, state.velocity = data.qpos[self.motor], data.qvel[self.motor]
        torque = command - gain * state.position - damping * state.velocity
        applied = torque
        for effect in self.drives:
            applied = effect.drive(applied)
        if self.frictions:
            self._set_level()
        push = applied - self.arm.offset
        for effect in self.torques:
            effect.torque(state, push)
        data.qfrc_applied[self.motor] = push
        for joint, effect in self.split.items():
            self._transmit(joint, effect)
        if self.loads:
            self._take_up()
        mujoco.mj_forward(self.model, data)
        self.before = self.velocity
        self.acceleration = data.qacc.copy()
        self.velocity = self.before + self.step * self.acceleration
        data.qpos += self.step * self.velocity
        state.time += self.step
        return torque

    def _set_level(self) -> None:
        data, motor, state = self.data, self.motor, self.state
        state.load = data.qfrc_applied[motor] + data.qfrc_constraint[motor] + data.qfrc_passive[motor]
        for joint in self.split:
            state.load[joint] += self.transmitted[joint]
        self.level[:] = self.arm.coulomb
        for effect in self.frictions:
            effect.friction(state, self.level)
        np.maximum(self.level, 0.0, out=self.level)
        self.model.dof_frictionloss[motor] = self.level

    def _transmit(self, joint: int, effect: Effect) -> None:
        data, motor = self.data, self.motor[joint]
        twist = data.qpos[motor] - data.qpos[joint]
        torque = effect.transmit(twist, data.qvel[motor] - data.qvel[joint])
        data.qfrc_applied[joint] = torque
        data.qfrc_applied[motor] -= torque
        self.transmitted[joint] = torque

    def _take_up(self) -> None:
        for number, effect in enumerate(self.loads):
            body = self.model.body(f"load_{number}").id
            if self.state.time >= effect.time and self.model.body_mass[body] < 1e-6:
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

    def seen(self) -> tuple[np.ndarray, ...]:
        """Give motor position, half-step velocities, acceleration, direction of own and of coupling friction.

        Those of the step just taken, at its beginning.
        """
        data, level, count = self.data, self.level, np.count_nonzero(self.arm.motors[:, 2])
        coupled = data.efc_force[-count:] if count else np.zeros(len(self.arm.motors))
        friction = -data.qfrc_constraint[self.motor]
        for coupling, force in zip(self.arm.robot.couplings, coupled, strict=True):
            friction[np.array(coupling.joints) - 1] += force * np.array(coupling.weights)
        if self.frictions:
            self._own_direction(friction)
        else:
            friction /= level
        sums = -coupled / self.arm.motors[:, 2] if count else coupled
        return self.state.position, self.before, self.velocity, self.acceleration, friction, sums

    def _own_direction(self, friction: np.ndarray) -> None:
        """Divide friction by its level; an effect that takes the level away tells the direction itself."""
        for joint, level in enumerate(self.level):
            told = self.state.memory.get(f"direction {joint}", np.sign(self.state.velocity[joint]))
            friction[joint] = friction[joint] / level if level > 0.0 else told


@dataclass(frozen=True, eq=False)
class Steering:
    """Hold a joint controller: its command is the clean arm's feed-forward plus gains times reference.

    `nominal` is the feed-forward alone, N m: the torque that the motion needs where nothing is hidden.
    """

    centre: np.ndarray
    command: np.ndarray
    nominal: np.ndarray
    gain: np.ndarray
    damping: np.ndarray


def steer(arm: Arm, excitation: Excitation, rate_hz: float = 250.0) -> Steering:
    """Tune PD gains to the arm's inertia and compute its feed-forward along the motion.

    The rigid-body part is computed at the log's rate and interpolated.
    """
    model = build(arm)
    coarse = np.arange(0.0, excitation.duration + 1.5 / rate_hz, 1.0 / rate_hz)
    rigid = inverse(model, excitation.at(coarse))
    fine = np.arange(round(excitation.duration * STEPS_PER_SECOND)) / STEPS_PER_SECOND
    position, velocity, acceleration = excitation.at(fine)
    nominal = np.column_stack([np.interp(fine, coarse, column) for column in rigid.T])
    nominal += arm.rotor_inertia * acceleration + arm.viscous * velocity + arm.offset
    nominal += arm.coulomb * np.tanh(velocity / (EASE * arm.speed))
    inertia = _inertia(model, excitation.centre) + arm.rotor_inertia
    for coupling, (rotor, viscous, coulomb) in zip(arm.robot.couplings, arm.motors, strict=True):
        joints, weights = np.array(coupling.joints) - 1, np.array(coupling.weights)
        rate = velocity[:, joints] @ weights
        motor = rotor * acceleration[:, joints] @ weights + viscous * rate
        motor += coulomb * np.tanh(rate / (EASE * arm.speed[joints].sum()))
        nominal[:, joints] += motor[:, None] * weights
        inertia[joints] += rotor * weights**2
    gain, damping = inertia * BANDWIDTH**2, 2.0 * DAMPING_RATIO * inertia * BANDWIDTH
    command = nominal + gain * position + damping * velocity
    return Steering(excitation.centre, command, nominal, gain, damping)


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
    rows = []
    for command in steering.command:
        torque = plant.advance(command, steering.gain, steering.damping)
        rows.append((torque, *plant.seen()))
    torque, position, before, after, acceleration, direction, sums = (
        np.array(column) for column in zip(*rows, strict=True)
    )
    velocity = 0.5 * (before + after)[:, plant.motor]
    series = (position, velocity, acceleration[:, plant.motor], torque, direction, sums)
    return Recording(round(STEPS_PER_SECOND / rate_hz), *series)


def _unchanged(series: np.ndarray) -> np.ndarray:
    return series


def inverse(model: mujoco.MjModel, motion: tuple[np.ndarray, np.ndarray, np.ndarray]) -> np.ndarray:
    """Give the torque (N m) that MuJoCo's rigid bodies need along position, velocity and acceleration."""
    data = mujoco.MjData(model)
    torque = np.empty_like(motion[0])
    for row, (position, velocity, acceleration) in enumerate(zip(*motion, strict=True)):
        data.qpos[:], data.qvel[:], data.qacc[:] = position, velocity, acceleration
        mujoco.mj_inverse(model, data)
        torque[row] = data.qfrc_inverse
    return torque


def _inertia(model: mujoco.MjModel, position: np.ndarray) -> np.ndarray:
    data = mujoco.MjData(model)
    data.qpos[:] = position
    mujoco.mj_forward(model, data)
    full = np.empty((model.nv, model.nv))
    for column, unit in zip(full, np.eye(model.nv), strict=True):
        mujoco.mj_mulM(model, data, column, unit)
    return np.diag(full).copy()


def _quaternion(rotation: np.ndarray) -> np.ndarray:
    """Write a rotation as w, x, y, z."""
    quaternion = np.empty(4)
    mujoco.mju_mat2Quat(quaternion, np.ascontiguousarray(rotation).ravel())
    return quaternion
