"""Simulate clean logs in a second world, made independently of the first, in which nothing is hidden.

A planar arm of two joints by its closed equations, sticking Coulomb friction as a complementarity
problem, and a position loop that sees the quantised encoder. The log's torque is the commanded one, so
that an error of the encoder is in the torque as in the positions. Loops are slow or stiff and encoders fine
or coarse: the stiffer the one and the coarser the other, the more of its error goes round. Sources: Spong,
Hutchinson & Vidyasagar, Robot Modeling and Control (2006), ch. 7, for the equations; Moreau, Unilateral
Contact and Dry Friction (1988), for friction.
"""

from dataclasses import dataclass, replace
from functools import reduce

import numpy as np

from tests.plant.second_effects import Change, Log, draw_changes
from tests.plant.sensors import noise as draw_noise
from veritorque.core.log.model import JointLog
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.model import RobotModel

STEP, CYCLE, RATE_HZ = 2.5e-4, 1e-3, 250.0
"""Seconds of an integration step and of a cycle of the controller; rate of the log."""
COUNTS = (2**19, 2**20, 2**21)
"""Encoder counts per turn, one of which is drawn."""
LOOP_HZ = (8.0, 25.0)
"""Lowest and highest bandwidth of a position loop."""
LINK, GRAVITY = 0.5, 9.81
"""Length of the first link, m, and gravity against y, m/s2."""
HIGHEST_HZ = {"smooth": (0.4, 1.0), "rich": (3.0, 6.0)}
"""Lowest and highest limit of the motion's frequencies."""
NOW = 0.625
"""Share in a row's torque of the cycle that begins, the rest being the last one's: both lie about the row."""
SWEEPS = 20
NOISE_SHARE, SECONDS = (0.002, 0.01), 30.0
"""Lowest and highest RMS of the torque noise over the torque's, and length of a log."""


@dataclass(frozen=True)
class Body:
    """Hold what the equations need: inertias (kg m2), coupling (kg m2), weights (N m), drives."""

    first: float
    second: float
    coupling: float
    weights: np.ndarray
    rotors: np.ndarray
    viscous: np.ndarray
    coulomb: np.ndarray

    def mass(self, angle: np.ndarray) -> np.ndarray:
        """Give the mass matrix, rotors included."""
        cross = self.coupling * np.cos(angle[1])
        both = self.second + cross
        return np.array(
            [
                [self.first + self.second + 2.0 * cross + self.rotors[0], both],
                [both, self.second + self.rotors[1]],
            ]
        )

    def bias(self, angle: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """Give the torque of motion and weight."""
        bend = self.coupling * np.sin(angle[1])
        tip = self.weights[1] * np.cos(angle[0] + angle[1])
        return np.array(
            [
                -bend * (2.0 * rate[0] + rate[1]) * rate[1] + self.weights[0] * np.cos(angle[0]) + tip,
                bend * rate[0] ** 2 + tip,
            ]
        )


@dataclass(frozen=True, eq=False)
class Reference:
    """Sum sines per joint: amplitudes (rad), rates (rad/s) and phases, sines x joints."""

    amplitude: np.ndarray
    rate: np.ndarray
    phase: np.ndarray

    def at(self, time: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Give angle, rate and acceleration, grown out of rest within a second."""
        grown = 1.0 - np.exp(-((time / 0.4) ** 3))
        angle = self.rate * time + self.phase
        size = grown * self.amplitude
        return (
            (size * np.sin(angle)).sum(axis=0),
            (size * self.rate * np.cos(angle)).sum(axis=0),
            -(size * self.rate**2 * np.sin(angle)).sum(axis=0),
        )


@dataclass(frozen=True)
class Drive:
    """Hold the bandwidth of the position loop (Hz) and the encoder's step (rad)."""

    loop_hz: float
    step: float


def draw_second(
    seed: int, motion: str, noise: str = "white", *, finer: float = 1.0
) -> tuple[RobotModel, JointLog]:
    """Draw a clean log with `smooth` or `rich` motion and a kind of noise; an encoder may be `finer`."""
    rng = np.random.default_rng([seed, 77])
    body, reference = _body(rng), _reference(rng, _between(rng, HIGHEST_HZ[motion]))
    drive = Drive(_between(rng, LOOP_HZ), 2.0 * np.pi / (float(rng.choice(COUNTS)) * finer))
    series = _recorded(_World(body, reference, drive), rng, noise)
    return robot(), log_from_arrays(f"second_{motion}_{noise}_{seed}", *series)


def draw_changed(
    seed: int, motion: str, noise: str = "white"
) -> tuple[RobotModel, JointLog, tuple[Change, ...]]:
    """Draw a log in which one or two textbook effects are hidden, and say which."""
    rng = np.random.default_rng([seed, 78, list(HIGHEST_HZ).index(motion)])
    body, reference = _body(rng), _reference(rng, _between(rng, HIGHEST_HZ[motion]))
    drive = Drive(_between(rng, LOOP_HZ), 2.0 * np.pi / float(rng.choice(COUNTS)))
    changes = draw_changes(rng, body.weights + body.coulomb)
    series = _recorded(_World(body, reference, drive, changes), rng, noise)
    return robot(), log_from_arrays(f"changed_{motion}_{noise}_{seed}", *series), changes


@dataclass(frozen=True, eq=False)
class _World:
    """Hold all that a simulation needs."""

    body: Body
    reference: Reference
    drive: Drive
    changes: tuple[Change, ...] = ()


def _recorded(world: _World, rng: np.random.Generator, noise: str) -> Log:
    """Simulate, add noise and log."""
    position, torque = _simulate(world, SECONDS)
    size = _between(rng, NOISE_SHARE) * torque.std(axis=0)
    torque = torque + size * draw_noise(noise, torque.shape, RATE_HZ, rng)
    logged = np.arange(len(position)) / RATE_HZ, position, torque
    return reduce(lambda seen, one: one.logged(seen), world.changes, logged)


def _between(rng: np.random.Generator, ends: tuple[float, float]) -> float:
    """Draw a number, evenly in its logarithm."""
    return float(np.exp(rng.uniform(*np.log(ends))))


def robot() -> RobotModel:
    """Describe the arm exactly."""
    joint = {"type": "revolute", "alpha": 0.0, "r": 0.0, "theta_offset": 0.0}
    joints = [{**joint, "name": f"joint_{number}", "d": d} for number, d in ((1, 0.0), (2, LINK))]
    return robot_from_description({"name": "second", "gravity": [0.0, -GRAVITY, 0.0], "joints": joints})


def _body(rng: np.random.Generator) -> Body:
    masses, centres = rng.uniform([4.0, 2.0], [8.0, 4.0]), rng.uniform(0.15, 0.3, 2)
    own = masses * centres**2 + rng.uniform(0.05, 0.15, 2)
    return Body(
        first=own[0] + masses[1] * LINK**2,
        second=own[1],
        coupling=masses[1] * LINK * centres[1],
        weights=GRAVITY * np.array([masses[0] * centres[0] + masses[1] * LINK, masses[1] * centres[1]]),
        rotors=rng.uniform(0.1, 0.4, 2),
        viscous=rng.uniform(1.0, 3.0, 2),
        coulomb=rng.uniform([3.0, 1.5], [6.0, 3.0]),
    )


def _reference(rng: np.random.Generator, highest_hz: float) -> Reference:
    rate = 2.0 * np.pi * np.exp(rng.uniform(np.log(0.1), np.log(highest_hz), (8, 2)))
    amplitude = rng.uniform(0.5, 1.0, (8, 2)) / rate
    return Reference(1.5 * amplitude / np.sqrt(8.0), rate, rng.uniform(-np.pi, np.pi, (8, 2)))


def _simulate(world: _World, seconds: float) -> tuple[np.ndarray, np.ndarray]:
    """Run loop and arm; give the encoder's angles and the commanded torque at the log's rate."""
    body, reference, drive, changes = world.body, world.reference, world.drive, world.changes
    angle, _, _ = reference.at(0.0)
    rate, command, friction, seen = np.zeros(2), np.zeros(2), np.zeros(2), angle
    last, count, loop = command, drive.step, 2.0 * np.pi * drive.loop_hz
    cycle, row = round(CYCLE / STEP), round(1.0 / (RATE_HZ * STEP))
    stiffness = np.diag(body.mass(np.array([0.0, 1.0]))) * loop**2
    damping = 1.6 * stiffness / loop
    rows = []
    for step in range(round(seconds / STEP)):
        if step % cycle == 0:
            last, before = command, seen
            seen = count * np.round(reduce(lambda own, one: one.seen(own), changes, angle) / count)
            wanted = reference.at(step * STEP)
            forward = body.mass(wanted[0]) @ wanted[2] + body.bias(wanted[0], wanted[1])
            slip = wanted[1] - (seen - before) / CYCLE
            command = forward + stiffness * (wanted[0] - seen) + damping * slip
        if step % row == 0:
            rows.append((seen, NOW * command + (1.0 - NOW) * last))
        now, pushed = _changed(changes, body, step * STEP, (angle, rate, command, friction))
        rate, friction = _moved(now, angle, rate, command + pushed, friction)
        angle = angle + STEP * rate
    position, torque = (np.array(column) for column in zip(*rows, strict=True))
    return position, torque


def _changed(
    changes: tuple[Change, ...], body: Body, time: float, state: tuple[np.ndarray, ...]
) -> tuple[Body, np.ndarray]:
    """Give the bodies, with their friction, and the torques that the effects add at a time."""
    angle, rate, command, friction = state
    pushed, level = np.zeros(2), body.coulomb.copy()
    for one in changes:
        joint = one.joint
        pushed[joint] += one.push(time, angle, rate)
        load = float(command[joint] - friction[joint] - body.viscous[joint] * rate[joint])
        level[joint] = one.level(float(level[joint]), time, float(angle[joint]), float(rate[joint]), load)
    return replace(reduce(lambda own, one: one.body(own, time), changes, body), coulomb=level), pushed


def _moved(
    body: Body, angle: np.ndarray, rate: np.ndarray, command: np.ndarray, friction: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Take one step: friction within its level is what stops the joints, by projected Gauss-Seidel."""
    mass = body.mass(angle) + STEP * np.diag(body.viscous)
    (a, b), (_, c) = (mass / STEP).tolist()
    det = a * c - b * b
    own, cross = (c / det, a / det), -b / det
    push = (command - body.bias(angle, rate) - body.viscous * rate).tolist()
    free = (rate[0] + own[0] * push[0] + cross * push[1], rate[1] + cross * push[0] + own[1] * push[1])
    held, level = friction.tolist(), body.coulomb.tolist()
    for _ in range(SWEEPS):
        last = tuple(held)
        for joint in (0, 1):
            wanted = (free[joint] - cross * held[1 - joint]) / own[joint]
            held[joint] = min(max(wanted, -level[joint]), level[joint])
        if last == tuple(held):
            break
    left = (free[0] - own[0] * held[0] - cross * held[1], free[1] - cross * held[0] - own[1] * held[1])
    return np.array(left), np.array(held)
