"""Give the arms of the estimators' bench with their true parameters, and the gains of their position loops.

The TX40's numbers are those that BIRDy publishes: github.com/TUM-ICS/BIRDy, file TX40.m of commit 3d8f2dc,
without the coupling of its wrist (TX40_uncoupled.m); Leboutet, Roux, Janot, Guadarrama-Olvera & Cheng,
Applied Sciences 11(9), 2021. The others are drawn by `tests.plant.robots`.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Final

import numpy as np
import pinocchio as pin

from tests.plant.robots import Arm, draw_arm
from tests.tools import pinocchio_model
from veritorque.core.robot.description import robot_from_description

_RIGHT = np.pi / 2
_SEED = 708
"""Seed of the arms that are drawn."""
_STIFF_HZ, _DAMPING_RATIO = 17.0, 0.4
"""Position loops of drawn arms are tuned to this bandwidth and damping at mid-room: about those of BIRDy's
TX40 on its first joint."""

_ROWS = (
    (0.0, 0.0, 0.32, 0.0),
    (-_RIGHT, 0.0, 0.0, -_RIGHT),
    (0.0, 0.225, 0.035, _RIGHT),
    (_RIGHT, 0.0, 0.225, 0.0),
    (-_RIGHT, 0.0, 0.0, 0.0),
    (_RIGHT, 0.0, 0.0, np.pi),
)
"""alpha (rad), d (m), r (m), theta (rad); the first r is the height of the base."""
_BODIES = (
    (0.424, 0.0, 0.0, 0.424, 0.0, 0.352, 0.0, 0.0, -0.4305, 8.61),
    (1.63e-2, 7.85e-4, -1.57e-2, 8.81e-2, 3.24e-4, 8.28e-2, 0.392, -7.2e-3, 0.162, 4.85),
    (2.23e-2, -1.95e-4, -1.16e-3, 2.24e-2, -2.22e-3, 4.41e-3, 3.26e-2, 2.44e-2, 0.265, 4.07),
    (0.109, 2.9e-5, 1.35e-3, 0.108, -1.17e-3, 4.07e-3, 1.45e-2, -7.24e-3, -0.586, 3.62),
    (1.01e-3, 0.0, 0.0, 1.00e-3, -3.06e-6, 1.01e-3, 0.0, -3.06e-3, -1.02e-3, 1.02),
    (3.53e-3, 0.0, 0.0, 3.53e-3, 0.0, 3.53e-4, 0.0, 0.0, 1.68e-3, 0.2),
)
"""XX XY XZ YY YZ ZZ about the link's origin (kg m2), MX MY MZ (kg m), M (kg)."""
_ROTORS = (0.362, 0.507, 8.29e-2, 3.41e-2, 3.61e-2, 1.14e-2)
_VISCOUS = (7.9379, 5.6948, 1.9804, 1.1141, 1.60, 0.6894)
_COULOMB = (6.9822, 7.8301, 6.1939, 2.4063, 3.4092, 1.8313)
_KP = 0.75 * np.array((455.8254, 500.0, 253.7919, 200.2182, 244.3226, 478.4783))
_KD = np.array((2.5361, 4.1174, 1.1793, 0.5462, 0.5714, 0.1954))
_KTAU = np.array((35.24, 32.04, 23.94, 9.05, 15.5, 6.56))
"""N m per unit of the command."""
_POSITION_DEG = ((-180, 180), (-125, 125), (-138, 138), (-270, 270), (-120, 133.5), (-270, 270))
_SPEED_DEG = (287.0, 287.0, 430.0, 410.0, 320.0, 700.0)
_ACCELERATION = 25.0
"""rad/s2, half of what BIRDy allows."""


@dataclass(frozen=True, eq=False)
class Driven:
    """Hold an arm and the gains of its stiff position loop, N m/rad and N m s/rad."""

    arm: Arm
    kp: np.ndarray
    kd: np.ndarray


@cache
def driven(name: str) -> Driven:
    """Give an arm of the bench."""
    if name == "tx40":
        return Driven(_tx40(), _KP * _KTAU, _KD * _KTAU)
    arm = draw_arm(ARMS[name], np.random.default_rng(_SEED))
    model = pinocchio_model(arm.robot, arm.bodies)
    mass = pin.crba(model, model.createData(), 0.5 * (arm.lower + arm.upper))
    inertia, rate = np.diag(mass) + arm.rotor_inertia, 2.0 * np.pi * _STIFF_HZ
    return Driven(arm, inertia * rate**2, 2.0 * _DAMPING_RATIO * inertia * rate)


ARMS: Final[Mapping[str, str]] = {"tx40": "", "yumi": "yumi-left", "planar": "planar-2"}
"""The bench's names of arms, and those of `tests.plant.robots` where they are drawn."""


def _tx40() -> Arm:
    lower, upper = np.deg2rad(np.array(_POSITION_DEG)).T
    speed = np.deg2rad(_SPEED_DEG)
    joints = [
        {
            "type": "revolute",
            "alpha": alpha,
            "d": d,
            "r": r,
            "theta_offset": theta,
            "limits": {"position": [low, high], "velocity": fastest, "torque": None},
        }
        for (alpha, d, r, theta), low, high, fastest in zip(_ROWS, lower, upper, speed, strict=True)
    ]
    description = {"name": "tx40", "joints": joints, "gravity": [0.0, 0.0, -9.81]}
    return Arm(
        name="tx40",
        robot=robot_from_description(description),
        bodies=np.array(_BODIES),
        rotor_inertia=np.array(_ROTORS),
        viscous=np.array(_VISCOUS),
        coulomb=np.array(_COULOMB),
        offset=np.zeros(len(joints)),
        motors=np.empty((0, 3)),
        lower=lower,
        upper=upper,
        speed=speed,
        acceleration=np.full(len(joints), _ACCELERATION),
    )
