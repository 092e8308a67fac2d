"""Offer the robots that need no description: ABB YuMi's arms, one by one and both on their body.

Sources: the modified DH table is Table 1 of the paper this project starts from (lengths there in cm); the
places of the arms on the body and the joint limits are those of the robot's public kinematic description. A
YuMi arm stands on a tilted base, which is why two more base parameters can be identified than on a level one.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..arrays import Rotation, Vector3
from ..errors import RobotError
from .description import LEVEL_GRAVITY, MODIFIED_DH, robot_from_description
from .frames import rotation_rpy
from .model import RobotModel
from .modified_dh import ModifiedDHRow, row_of_placement

_PI = float(np.pi)
_ARM = (
    ModifiedDHRow(alpha=0.0, d=0.0, r=0.166, theta=-_PI),
    ModifiedDHRow(alpha=_PI / 2, d=0.03, r=0.0, theta=-_PI),
    ModifiedDHRow(alpha=_PI / 2, d=0.03, r=0.2515, theta=0.0),
    ModifiedDHRow(alpha=-_PI / 2, d=0.0405, r=0.0, theta=-_PI / 2),
    ModifiedDHRow(alpha=-_PI / 2, d=0.0405, r=0.265, theta=_PI),
    ModifiedDHRow(alpha=-_PI / 2, d=0.027, r=0.0, theta=-_PI),
    ModifiedDHRow(alpha=-_PI / 2, d=0.027, r=0.036, theta=_PI),
)
_LIMITS_DEGREES = (
    (-168.5, 168.5),
    (-143.5, 43.5),
    (-168.5, 168.5),
    (-123.5, 80.0),
    (-290.0, 290.0),
    (-88.0, 138.0),
    (-229.0, 229.0),
)


@dataclass(frozen=True)
class _Mount:
    """Place an arm's base on the body: roll, pitch, yaw in rad and position in m."""

    rpy: tuple[float, float, float]
    xyz: tuple[float, float, float]

    @property
    def rotation(self) -> Rotation:
        return rotation_rpy(*self.rpy)


_MOUNTS: Mapping[str, _Mount] = {
    "left": _Mount((0.9781, -0.5716, 2.3180), (0.05355, 0.0725, 0.41492)),
    "right": _Mount((-0.9795, -0.5682, -2.3155), (0.05355, -0.0725, 0.41492)),
}


def builtin_robots() -> tuple[str, ...]:
    """List the names of the built-in robots."""
    return ("yumi-left", "yumi-right", "yumi")


def builtin_robot(name: str) -> RobotModel:
    """Give a built-in robot.

    Raises
    ------
    RobotError
        If there is no built-in robot of this name.

    Examples
    --------
    >>> len(builtin_robot("yumi").joints)
    14
    """
    return robot_from_description(builtin_description(name))


def builtin_description(name: str) -> dict[str, object]:
    """Give the description of a built-in robot.

    Raises
    ------
    RobotError
        If there is no built-in robot of this name.
    """
    if name not in builtin_robots():
        raise RobotError(
            "there is no built-in robot of this name",
            evidence={"name": name[:80], "known": list(builtin_robots())},
            remedy="choose a known one or send a description",
        )
    if name == "yumi":
        joints = _joints("left", antecedent=0) + _joints("right", antecedent=7)
        return _description(name, joints, np.array(LEVEL_GRAVITY))
    mount = _MOUNTS[name.removeprefix("yumi-")]
    return _description(name, _joints(None, antecedent=0), mount.rotation.T @ np.array(LEVEL_GRAVITY))


def _description(name: str, joints: list[dict[str, object]], gravity: Vector3) -> dict[str, object]:
    return {
        "name": name,
        "convention": MODIFIED_DH,
        "joints": joints,
        "gravity": [float(part) for part in gravity],
        "couplings": [],
        "prior": None,
    }


def _joints(side: str | None, *, antecedent: int) -> list[dict[str, object]]:
    """Write an arm's table: on its own base, or on the body with the mount folded into its first row."""
    rows = list(_ARM)
    if side is not None:
        mount = _MOUNTS[side]
        rotation, translation = rows[0].placement()
        rows[0] = row_of_placement(
            mount.rotation @ rotation, mount.rotation @ translation + np.array(mount.xyz)
        )
    return [
        {
            "name": f"joint_{number}" if side is None else f"{side}_joint_{number}",
            "type": "revolute",
            "antecedent": 0 if number == 1 else antecedent + number - 1,
            "alpha": row.alpha,
            "d": row.d,
            "r": row.r,
            "theta_offset": row.theta,
            "gamma": row.gamma,
            "b": row.b,
            "limits": {
                "position": [float(limit) for limit in np.radians(limits)],
                "velocity": None,
                "torque": None,
            },
            "rotor_inertia": True,
            "friction": ["viscous", "coulomb", "offset"],
            "torque_constant": None,
            "gear_ratio": None,
        }
        for number, (row, limits) in enumerate(zip(rows, _LIMITS_DEGREES, strict=True), start=1)
    ]
