"""Describe six arms as their users believe them, and draw the bodies and drives that they really have.

Geometry and limits are public data sheets' and public kinematic tables'; masses, friction and rotor inertias
are of the size that identification studies of these arms report, scattered by a seed, so that no two cases
share a robot. Sources: the ABB IRB 14000 study behind `core.robot.builtin`; Franka Emika's published
denavit-hartenberg table (Craig's form); Universal Robots' published UR10e table, moved from the classic to
the modified form; Janot, Vandanjon & Gautier, IEEE TCST 22(1), 2014, for the Staubli TX40 and its coupled
wrist.
"""

from dataclasses import dataclass

import numpy as np

from veritorque.core.robot.builtin import builtin_description
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.inertia import from_mass_properties
from veritorque.core.robot.model import RobotModel

_RIGHT = np.pi / 2


@dataclass(frozen=True)
class Sheet:
    """Hold an arm's data sheet: rows (alpha, d, r, theta) in rad and m, and per joint its scales in SI.

    `room` are the positions (rad) the excitation may use, `speed` (rad/s) and `acceleration` (rad/s2) its
    bounds; `radius` (m) is the links' thickness. A coupling is (joints, IAM, FVM, FCM).
    """

    rows: tuple[tuple[float, float, float, float], ...]
    room: tuple[tuple[float, float], ...]
    speed: tuple[float, ...]
    acceleration: tuple[float, ...]
    mass: tuple[float, ...]
    radius: float
    rotor_inertia: tuple[float, ...]
    viscous: tuple[float, ...]
    coulomb: tuple[float, ...]
    coupling: tuple[tuple[int, int], float, float, float] | None = None


@dataclass(frozen=True, eq=False)
class Arm:
    """Hold one drawn robot: what its user believes, and what is true.

    Attributes
    ----------
    robot
        True geometry, gravity and couplings; its user believes the same, unless an effect says otherwise.
    bodies
        Ten true inertial parameters per link.
    rotor_inertia, viscous, coulomb, offset
        The true drives: kg m2, N m s/rad, N m and N m.
    motors
        One row (IAM, FVM, FCM) per coupling.
    lower, upper, speed, acceleration
        Bounds of the excitation, in rad, rad/s and rad/s2.
    """

    name: str
    robot: RobotModel
    bodies: np.ndarray
    rotor_inertia: np.ndarray
    viscous: np.ndarray
    coulomb: np.ndarray
    offset: np.ndarray
    motors: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    speed: np.ndarray
    acceleration: np.ndarray

    @property
    def joints(self) -> int:
        """Count the joints."""
        return len(self.speed)


_YUMI = builtin_description("yumi-left")["joints"]

SHEETS: dict[str, Sheet] = {
    "yumi-left": Sheet(
        rows=tuple((row["alpha"], row["d"], row["r"], row["theta_offset"]) for row in _YUMI),
        room=((-2.6, 2.6), (-2.2, 0.6), (-2.6, 2.6), (-1.9, 1.2), (-3.0, 3.0), (-1.4, 2.2), (-3.0, 3.0)),
        speed=(3.0, 3.0, 3.0, 3.0, 6.5, 6.5, 6.5),
        acceleration=(10.0, 10.0, 14.0, 14.0, 25.0, 25.0, 30.0),
        mass=(2.1, 1.6, 1.3, 1.1, 0.8, 0.5, 0.35),
        radius=0.04,
        rotor_inertia=(0.025, 0.04, 0.032, 0.066, 0.012, 0.005, 0.004),
        viscous=(0.37, 0.76, 0.18, 0.18, 0.044, 0.039, 0.045),
        coulomb=(2.2, 1.8, 0.72, 0.84, 0.23, 0.18, 0.13),
    ),
    "franka-panda": Sheet(
        rows=(
            (0.0, 0.0, 0.333, 0.0),
            (-_RIGHT, 0.0, 0.0, 0.0),
            (_RIGHT, 0.0, 0.316, 0.0),
            (_RIGHT, 0.0825, 0.0, 0.0),
            (-_RIGHT, -0.0825, 0.384, 0.0),
            (_RIGHT, 0.0, 0.0, 0.0),
            (_RIGHT, 0.088, 0.0, 0.0),
        ),
        room=((-2.6, 2.6), (-1.5, 1.5), (-2.6, 2.6), (-2.9, -0.2), (-2.6, 2.6), (0.2, 3.5), (-2.6, 2.6)),
        speed=(2.17, 2.17, 2.17, 2.17, 2.61, 2.61, 2.61),
        acceleration=(12.0, 7.5, 10.0, 12.0, 15.0, 20.0, 20.0),
        mass=(4.9, 3.4, 3.3, 3.6, 3.2, 1.7, 1.4),
        radius=0.06,
        rotor_inertia=(0.55, 0.6, 0.45, 0.5, 0.2, 0.2, 0.15),
        viscous=(0.9, 1.2, 0.7, 0.8, 0.5, 0.3, 0.4),
        coulomb=(1.4, 1.6, 1.0, 1.2, 0.9, 0.6, 0.6),
    ),
    "ur10e": Sheet(
        rows=(
            (0.0, 0.0, 0.1807, 0.0),
            (_RIGHT, 0.0, 0.0, 0.0),
            (0.0, -0.6127, 0.0, 0.0),
            (0.0, -0.57155, 0.17415, 0.0),
            (_RIGHT, 0.0, 0.11985, 0.0),
            (-_RIGHT, 0.0, 0.11655, 0.0),
        ),
        room=((-2.8, 2.8), (-2.4, -0.4), (-2.2, 2.2), (-2.8, 2.8), (-2.8, 2.8), (-2.8, 2.8)),
        speed=(2.0, 2.0, 3.0, 3.0, 3.0, 3.0),
        acceleration=(7.0, 6.0, 9.0, 14.0, 16.0, 18.0),
        mass=(7.4, 13.0, 4.0, 2.1, 2.0, 0.9),
        radius=0.07,
        rotor_inertia=(2.6, 2.6, 1.1, 0.25, 0.25, 0.2),
        viscous=(12.0, 12.0, 7.0, 1.8, 1.8, 1.6),
        coulomb=(9.0, 11.0, 6.0, 1.8, 1.6, 1.5),
    ),
    "staubli-tx40": Sheet(
        rows=(
            (0.0, 0.0, 0.32, 0.0),
            (-_RIGHT, 0.0, 0.0, 0.0),
            (0.0, 0.225, 0.035, 0.0),
            (_RIGHT, 0.0, 0.225, 0.0),
            (-_RIGHT, 0.0, 0.0, 0.0),
            (_RIGHT, 0.0, 0.0, np.pi),
        ),
        room=((-2.6, 2.6), (-1.9, 1.9), (-2.1, 2.1), (-2.8, 2.8), (-1.9, 1.9), (-2.8, 2.8)),
        speed=(3.5, 3.5, 4.5, 6.0, 6.0, 7.0),
        acceleration=(14.0, 12.0, 18.0, 25.0, 25.0, 30.0),
        mass=(9.0, 7.5, 4.5, 2.6, 0.9, 0.35),
        radius=0.05,
        rotor_inertia=(0.37, 0.42, 0.12, 0.03, 0.06, 0.012),
        viscous=(7.9, 5.5, 2.0, 1.1, 1.5, 0.35),
        coulomb=(7.0, 8.0, 6.0, 2.4, 2.6, 0.5),
        coupling=((5, 6), 0.02, 0.6, 1.7),
    ),
    "planar-2": Sheet(
        rows=((_RIGHT, 0.0, 0.0, 0.0), (0.0, 0.5, 0.0, 0.0)),
        room=((-2.6, 2.6), (-2.4, 2.4)),
        speed=(3.0, 4.0),
        acceleration=(9.0, 16.0),
        mass=(6.0, 3.5),
        radius=0.06,
        rotor_inertia=(0.5, 0.15),
        viscous=(3.0, 1.2),
        coulomb=(4.0, 1.8),
    ),
    "planar-3": Sheet(
        rows=((_RIGHT, 0.0, 0.0, 0.0), (0.0, 0.45, 0.0, 0.0), (0.0, 0.4, 0.0, 0.0)),
        room=((-2.6, 2.6), (-2.4, 2.4), (-2.4, 2.4)),
        speed=(2.5, 3.5, 5.0),
        acceleration=(8.0, 13.0, 22.0),
        mass=(6.5, 4.0, 2.0),
        radius=0.06,
        rotor_inertia=(0.6, 0.2, 0.05),
        viscous=(4.0, 1.5, 0.4),
        coulomb=(5.0, 2.2, 0.7),
    ),
}
"""Six arms; the planar ones move in a vertical plane."""

ROBOTS = tuple(SHEETS)


def draw_arm(name: str, rng: np.random.Generator) -> Arm:
    """Draw bodies and drives for an arm: masses within 15 %, drives within 30 % of the sheet's size."""
    sheet = SHEETS[name]
    joints = len(sheet.rows)
    robot = robot_from_description(_description(name, sheet))
    lower, upper = np.array(sheet.room).T
    motors = np.array([sheet.coupling[1:]]) if sheet.coupling else np.empty((0, 3))
    coulomb = np.array(sheet.coulomb) * rng.uniform(0.7, 1.3, joints)
    return Arm(
        name=name,
        robot=robot,
        bodies=_bodies(robot, sheet, rng),
        rotor_inertia=np.array(sheet.rotor_inertia) * rng.uniform(0.7, 1.3, joints),
        viscous=np.array(sheet.viscous) * rng.uniform(0.7, 1.3, joints),
        coulomb=coulomb,
        offset=coulomb * rng.uniform(-0.4, 0.4, joints),
        motors=motors * rng.uniform(0.8, 1.2, motors.shape),
        lower=lower,
        upper=upper,
        speed=np.array(sheet.speed),
        acceleration=np.array(sheet.acceleration),
    )


def _bodies(robot: RobotModel, sheet: Sheet, rng: np.random.Generator) -> np.ndarray:
    """Draw rod-like bodies which reach from their own frame half-way to the next link's."""
    ends = [link.translation for link in robot.links[1:]] + [np.array([0.0, 0.0, 2.0 * sheet.radius])]
    bodies = []
    for mass, end in zip(sheet.mass, ends, strict=True):
        own = mass * rng.uniform(0.85, 1.15)
        centre = 0.5 * end + rng.normal(scale=0.4 * sheet.radius, size=3)
        skew = rng.normal(scale=0.25 * sheet.radius, size=(3, 3))
        second = own * (0.25 * sheet.radius**2 * np.eye(3) + np.outer(end, end) / 12.0 + skew @ skew.T)
        bodies.append(from_mass_properties(own, centre, np.trace(second) * np.eye(3) - second))
    return np.array(bodies)


def _description(name: str, sheet: Sheet) -> dict[str, object]:
    joints = [
        {
            "type": "revolute",
            "alpha": alpha,
            "d": d,
            "r": r,
            "theta_offset": theta,
            "limits": {"position": [low - 0.3, high + 0.3], "velocity": 1.2 * speed, "torque": None},
        }
        for (alpha, d, r, theta), (low, high), speed in zip(sheet.rows, sheet.room, sheet.speed, strict=True)
    ]
    couplings = (
        [{"name": "wrist", "joints": list(sheet.coupling[0]), "weights": [1.0, 1.0]}]
        if sheet.coupling
        else []
    )
    gravity = builtin_description(name)["gravity"] if name == "yumi-left" else [0.0, 0.0, -9.81]
    return {"name": name, "joints": joints, "gravity": gravity, "couplings": couplings}
