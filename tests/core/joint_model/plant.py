"""Simulate one joint under a sampled controller, exactly between samples, by scipy's discretisation.

Nothing of the code under test is used: the joint is a state-space model under zero-order hold, stepped in
Python, and its dry friction takes what brings the motor to rest at the next sample.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.signal import cont2discrete

from veritorque.core.log.model import JointLog
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.model import RobotModel

RATE = 1000.0


@dataclass(frozen=True)
class Plant:
    """Hold a joint: inertias kg m2, stiffness N m/rad, damping and friction N m s/rad, N m."""

    motor: float = 0.5
    link: float = 1.2
    stiffness: float | None = 2000.0
    """None for a rigid joint."""
    damping: float = 2.0
    viscous: float = 5.0
    coulomb: float = 0.0
    offset: float = 0.0
    gravity: float = 0.0
    """Torque by the sine of the link's position, N m; it is held between samples as well."""

    @staticmethod
    def with_mode(hertz: float, **others: float) -> "Plant":
        """Give a joint whose motor and link swing against each other so often a second."""
        stiffness = (2.0 * np.pi * hertz) ** 2 / (1.0 / 0.5 + 1.0 / 1.2)
        return Plant(stiffness=stiffness, damping=1.2e-2 * stiffness / hertz, **others)

    @property
    def inertia(self) -> float:
        return self.motor + self.link

    def system(self) -> tuple[np.ndarray, np.ndarray]:
        """Give the states' derivative by states, and by torques on motor and link."""
        if self.stiffness is None:
            gain = 1.0 / self.inertia
            return np.array([[0.0, 1.0], [0.0, -gain * self.viscous]]), np.array([[0.0, 0.0], [gain, gain]])
        jm, jl, k, d, fv = self.motor, self.link, self.stiffness, self.damping, self.viscous
        states = [
            [0.0, 1.0, 0.0, 0.0],
            [-k / jm, -(d + fv) / jm, k / jm, d / jm],
            [0.0, 0.0, 0.0, 1.0],
            [k / jl, d / jl, -k / jl, -d / jl],
        ]
        return np.array(states), np.array([[0.0, 0.0], [1.0 / jm, 0.0], [0.0, 0.0], [0.0, 1.0 / jl]])


@dataclass(frozen=True)
class Run:
    """Say how a log is recorded."""

    highest_hz: float = 20.0
    seconds: float = 12.0
    amplitude: float = 0.6
    noise: float = 0.0
    """RMS of the encoder's noise, which the controller sees too, rad."""
    torque_noise: float = 0.0
    seed: int = 1
    kp: float = 500.0
    """Gains per unit of inertia, 1/s2 and 1/s."""
    kd: float = 24.0
    rate: float = RATE
    frequencies: int = 24
    begin: float = field(default=0.2)


def recorded(plant: Plant, run: Run) -> dict[str, np.ndarray]:
    """Record time, position, torque and reference."""
    rng = np.random.default_rng(run.seed)
    step = 1.0 / run.rate
    time = np.arange(round(run.seconds * run.rate)) * step
    hertz = np.linspace(0.2, run.highest_hz, run.frequencies)
    phases = rng.uniform(0.0, 2.0 * np.pi, len(hertz))
    sizes = run.amplitude / (2.0 * np.pi * hertz) ** 1.5
    reference = np.sin(2.0 * np.pi * np.outer(time, hertz) + phases) @ sizes
    reference = run.begin + reference * (1.0 - np.exp(-((time / 0.3) ** 2)))
    system, gain = plant.system()
    discrete, held, *_ = cont2discrete((system, gain, np.eye(len(system)), np.zeros_like(gain)), step)
    held, pulled = held.T
    state = np.tile([run.begin, 0.0], len(system) // 2)
    if plant.stiffness is not None:  # at rest the spring carries the link
        state[2] -= plant.gravity * np.sin(run.begin) / plant.stiffness
    position, torque = np.empty_like(time), np.empty_like(time)
    seen, wanted = run.begin, run.begin
    kp, kd = run.kp * plant.inertia, run.kd * plant.inertia
    encoder = run.noise * rng.standard_normal(len(time))
    pushes = run.torque_noise * rng.standard_normal(len(time))
    for k in range(len(time)):
        last, seen = seen, state[0] + encoder[k]
        before, wanted = wanted, reference[k]
        position[k] = seen
        torque[k] = kp * (wanted - seen) + kd * ((wanted - before) - (seen - last)) / step
        free = discrete @ state + held * (torque[k] + pushes[k] - plant.offset)
        free -= plant.gravity * np.sin(state[-2]) * pulled
        rub = np.clip(free[1] / held[1], -plant.coulomb, plant.coulomb)
        state = free - held * rub
    return {"time": time, "position": position, "torque": torque, "reference": reference}


def log_of(signals: dict[str, np.ndarray], *, reference: bool = True, others: int = 0) -> JointLog:
    """Write a recording as a log, with further joints that stand behind the first one."""
    still = np.zeros((len(signals["time"]), others))
    position, torque = (np.column_stack([signals[name], still]) for name in ("position", "torque"))
    channels = {}
    if reference:
        wanted = np.column_stack([signals["reference"], still])
        channels = {"position_ref": wanted, "torque_ref": torque}
    return log_from_arrays("joint", signals["time"], position, torque, **channels)


def robot_of(joints: int = 1, *, level: bool = False) -> RobotModel:
    """Describe an arm of vertical axes, on which gravity gives no torque; or of level ones."""
    gravity = [0.0, -9.81, 0.0] if level else [0.0, 0.0, -9.81]
    rows = [
        {"type": "revolute", "alpha": 0.0, "d": 0.4 * (n > 0), "r": 0.0, "theta_offset": 0.0}
        for n in range(joints)
    ]
    return robot_from_description({"name": "made", "joints": rows, "gravity": gravity})
