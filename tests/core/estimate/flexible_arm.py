"""Simulate arms whose joints give way, in MuJoCo: a motor, a spring with a damper, and the link behind it.

The motor is a hinge with the rotor's inertia, and the link turns about the same axis by what the spring gives
way. A controller on the motors' side pulls them along many sines. The engine steps every 0.1 ms.
"""

from dataclasses import dataclass, replace

import mujoco
import numpy as np

from veritorque.core.log.model import JointLog
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.model import RobotModel

STEP, RATE = 1e-4, 1000.0
ENCODER = np.deg2rad(1e-3)
"""Noise of the encoders, rad."""


@dataclass(frozen=True)
class FlexibleArm:
    """Describe an arm of one horizontal axis, or of a vertical and two horizontal ones."""

    alphas: tuple[float, ...]
    lengths: tuple[float, ...]
    masses: tuple[float, ...]
    centres: tuple[tuple[float, float, float], ...]
    inertias: tuple[tuple[float, float, float], ...]
    """Of the links about their mass centres, kg m2."""
    rotors: tuple[float, ...]
    """Rotor inertias, kg m2."""
    seen: tuple[float, ...]
    """Inertias that the springs see on the way, about: kg m2."""
    viscous: tuple[float, ...]
    coulomb: tuple[float, ...]
    mode_hz: tuple[float, ...]
    """Frequency at which motor and link swing against each other; infinite for a rigid joint."""
    damping_ratio: float = 0.02

    @property
    def joints(self) -> int:
        return len(self.masses)

    @property
    def stiffness(self) -> np.ndarray:
        seen, rotors = np.array(self.seen), np.array(self.rotors)
        return (2.0 * np.pi * np.array(self.mode_hz)) ** 2 * seen * rotors / (seen + rotors)

    @property
    def damping(self) -> np.ndarray:
        seen, rotors = np.array(self.seen), np.array(self.rotors)
        moved = seen * rotors / (seen + rotors)
        return 2.0 * self.damping_ratio * 2.0 * np.pi * np.array(self.mode_hz) * moved

    def with_mode(self, *hertz: float) -> "FlexibleArm":
        return replace(self, mode_hz=hertz if len(hertz) > 1 else hertz * self.joints)

    @property
    def robot(self) -> RobotModel:
        rows = [
            {"type": "revolute", "alpha": alpha, "d": length, "r": 0.0, "theta_offset": 0.0}
            for alpha, length in zip(self.alphas, self.lengths, strict=True)
        ]
        return robot_from_description({"name": "flexible", "joints": rows, "gravity": [0.0, 0.0, -9.81]})

    def engine(self) -> mujoco.MjModel:
        inner = ""
        for j in reversed(range(self.joints)):
            inner = self._body(j, inner)
        return mujoco.MjModel.from_xml_string(
            '<mujoco><compiler angle="radian" eulerseq="xyz"/>'
            f'<option timestep="{STEP}" gravity="0 0 -9.81" integrator="implicitfast"/>'
            f"<worldbody>{inner}</worldbody></mujoco>"
        )

    def _body(self, j: int, inner: str) -> str:
        """Write a motor and a link that carries what is within; friction holds as stiffly as steps allow."""
        place = f'pos="{self.lengths[j]!r} 0 0" euler="{self.alphas[j]!r} 0 0"'
        motor = (
            f'<joint name="m{j}" type="hinge" axis="0 0 1" armature="{self.rotors[j]!r}"'
            f' damping="{self.viscous[j]!r}" frictionloss="{self.coulomb[j]!r}"'
            ' solreffriction="0.0005 1" solimpfriction="0.999 0.9999 0.001"/>'
        )
        mass = _inertial(self.masses[j], self.centres[j], self.inertias[j])
        if np.isinf(self.mode_hz[j]):
            return f"<body {place}>{motor}{mass}{inner}</body>"
        spring = (
            f'<joint name="s{j}" type="hinge" axis="0 0 1" stiffness="{float(self.stiffness[j])!r}"'
            f' damping="{float(self.damping[j])!r}"/>'
        )
        nothing = _inertial(1e-6, (0.0, 0.0, 0.0), (1e-9, 1e-9, 1e-9))
        return f"<body {place}>{motor}{nothing}<body>{spring}{mass}{inner}</body></body>"


def _inertial(mass: float, centre: tuple[float, ...], inertia: tuple[float, ...]) -> str:
    x, y, z = centre
    a, b, c = inertia
    return f'<inertial mass="{mass!r}" pos="{x!r} {y!r} {z!r}" diaginertia="{a!r} {b!r} {c!r}"/>'


ONE = FlexibleArm(
    (np.pi / 2,),
    (0.0,),
    (6.0,),
    ((0.25, 0.02, 0.0),),
    ((0.02, 0.25, 0.24),),
    (0.5,),
    (0.62,),
    (3.0,),
    (2.0,),
    (12.0,),
)
THREE = FlexibleArm(
    (0.0, np.pi / 2, 0.0),
    (0.0, 0.1, 0.4),
    (8.0, 6.0, 3.0),
    ((0.02, 0.0, -0.1), (0.2, 0.02, 0.01), (0.15, -0.01, 0.02)),
    ((0.08, 0.07, 0.06), (0.03, 0.15, 0.16), (0.01, 0.06, 0.065)),
    (0.9, 1.0, 0.15),
    (1.3, 1.3, 0.13),
    (6.0, 5.0, 2.0),
    (4.0, 4.0, 1.5),
    (12.0, 12.0, 12.0),
)


@dataclass(frozen=True, eq=False)
class Recorded:
    time: np.ndarray
    position: np.ndarray
    torque: np.ndarray

    def log(self, seed: int, encoder: float = ENCODER, torque_share: float = 0.002) -> JointLog:
        rng = np.random.default_rng(seed)
        position = self.position + encoder * rng.normal(size=self.position.shape)
        spread = torque_share * self.torque.std(axis=0)
        torque = self.torque + spread * rng.normal(size=self.torque.shape)
        return log_from_arrays("flexible", self.time, position, torque)


def recorded(arm: FlexibleArm, highest_hz: float, seconds: float, seed: int = 1) -> Recorded:
    """Record motors and their torques while they follow sines up to a frequency."""
    model = arm.engine()
    data = mujoco.MjData(model)
    count, every = arm.joints, round(1.0 / (RATE * STEP))
    first, *others = (int(model.joint(f"m{j}").qposadr[0]) for j in range(count))
    motors = np.s_[first :: others[0] - first] if others else np.s_[first : first + 1]
    angle, speed, push = data.qpos[motors], data.qvel[motors], data.qfrc_applied[motors]  # as they are now
    reference, rate = _reference(count, highest_hz, seconds, seed)
    inertia = np.array(arm.seen) + np.array(arm.rotors)
    kp, kd = 400.0 * inertia, 28.0 * inertia
    position, torque = np.zeros((2, len(reference) // every, count))
    mujoco.mj_forward(model, data)
    for k in range(len(reference)):
        command = kp * (reference[k] - angle) + kd * (rate[k] - speed)
        if k % every == 0:
            position[k // every], torque[k // every] = angle, command
        push[:] = command
        mujoco.mj_step(model, data)
    return Recorded(np.arange(len(position)) / RATE, position, torque)


def _reference(joints: int, highest_hz: float, seconds: float, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Draw sines up to a frequency, slow ones large, and give their rate too."""
    rng, time = np.random.default_rng(seed), np.arange(round(seconds / STEP)) * STEP
    slow, fast = np.linspace(0.1, 1.0, 8), np.geomspace(1.5, highest_hz, 24)
    hertz = np.concatenate([slow, fast])
    sizes = np.concatenate([0.25 / np.sqrt(slow), 4.0 / (2.0 * np.pi * fast) ** 1.75])
    angles = 2.0 * np.pi * np.outer(time, hertz)
    drawn = [np.sin(angles + rng.uniform(0.0, 2.0 * np.pi, len(hertz))) @ sizes for _ in range(joints)]
    reference = np.stack(drawn, axis=1) * (1.0 - np.exp(-((time[:, None] / 0.3) ** 2)))
    return reference, np.gradient(reference, STEP, axis=0)
