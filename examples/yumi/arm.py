"""Hold what is known or assumed of the left YuMi arm: geometry, limits, drives and sensors.

Everything that the simulation takes for true and that is not a link body stands here; the bodies stand in
`bodies.json`. Sources: the identification study of the ABB IRB 14000 whose Tables 1 to 3 give geometry,
friction, offsets and rotor inertias; ABB's published joint limits; the arm base's pose on the body for the
direction of gravity.
"""

import json
from pathlib import Path
from typing import Final

import numpy as np

HERE: Final = Path(__file__).parent
JOINTS: Final = 7
SYMBOLS: Final = ("XX", "XY", "XZ", "YY", "YZ", "ZZ", "MX", "MY", "MZ", "M")

# Table 1, modified Denavit-Hartenberg (Khalil-Kleinfinger), rad and m; gamma and b are zero on a chain.
ALPHA: Final = np.array([0.0, 0.5, 0.5, -0.5, -0.5, -0.5, -0.5]) * np.pi
D: Final = np.array([0.0, 0.03, 0.03, 0.0405, 0.0405, 0.027, 0.027])
R: Final = np.array([0.166, 0.0, 0.2515, 0.0, 0.265, 0.0, 0.036])
THETA_OFFSET: Final = np.array([-1.0, -1.0, 0.0, -0.5, 1.0, -1.0, 1.0]) * np.pi

ROLL: Final = 0.9781
PITCH: Final = -0.5716
"""Roll and pitch of the arm's base on the upright body, rad; its yaw does not turn gravity."""
GRAVITY: Final = 9.81 * np.array(
    [np.sin(PITCH), -np.sin(ROLL) * np.cos(PITCH), -np.cos(ROLL) * np.cos(PITCH)]
)
"""Gravitational acceleration in the arm's base frame, m/s2."""

LOWER: Final = np.radians([-168.5, -143.5, -168.5, -123.5, -290.0, -88.0, -229.0])
UPPER: Final = np.radians([168.5, 43.5, 168.5, 80.0, 290.0, 138.0, 229.0])
MAX_VELOCITY: Final = np.radians([180.0, 180.0, 180.0, 180.0, 400.0, 400.0, 400.0])

# Table 2: viscous friction in N m s/rad, Coulomb friction and offset in N m; the offset of joint 3 is missing
# there.
VISCOUS: Final = np.array([0.367, 0.758, 0.183, 0.18, 0.044, 0.039, 0.045])
COULOMB: Final = np.array([2.175, 1.826, 0.718, 0.836, 0.228, 0.183, 0.132])
OFFSET: Final = np.array([3.117, 1.241, 0.0, -0.447, 0.08, -0.17, -0.011])

# Table 3 gives joints 3 to 5. Joints 1 and 2 carry larger motors than joint 3, but the table's ZZR1 = 0.064
# and ZZR2 = 0.224 contain them together with all links; joints 6 and 7 carry smaller ones than joint 5.
ROTOR_INERTIA: Final = np.array([0.025, 0.040, 0.0319, 0.0663, 0.0119, 0.0050, 0.0040])

RATE_HZ: Final = 250.0
ENCODER_STEP: Final = 2.0 * np.pi / (4096 * 100)
"""One count of a 12 bit motor encoder behind a 1:100 gear, rad at the joint."""


def link_bodies() -> list[dict[str, object]]:
    """Read the link bodies: per link its mass (kg), mass centre (m) and inertia about that centre (kg m2)."""
    document = json.loads((HERE / "bodies.json").read_text(encoding="utf-8"))
    return list(document["links"])


def robot_description() -> dict[str, object]:
    """Describe the arm for the service: geometry, limits and gravity, without what is to be identified."""
    joints = [
        {
            "name": f"joint_{number + 1}",
            "type": "revolute",
            "antecedent": number,
            "alpha": float(ALPHA[number]),
            "d": float(D[number]),
            "r": float(R[number]),
            "theta_offset": float(THETA_OFFSET[number]),
            "gamma": 0.0,
            "b": 0.0,
            "limits": {
                "position": [round(float(LOWER[number]), 6), round(float(UPPER[number]), 6)],
                "velocity": round(float(MAX_VELOCITY[number]), 6),
                "torque": None,
            },
            "rotor_inertia": True,
            "friction": ["viscous", "coulomb", "offset"],
            "torque_constant": None,
            "gear_ratio": None,
        }
        for number in range(JOINTS)
    ]
    return {
        "name": "yumi-left",
        "convention": "modified-dh",
        "joints": joints,
        "gravity": GRAVITY.tolist(),
        "couplings": [],
        "prior": None,
    }
