"""A two-joint arm in a vertical plane, whose torque fits on one page and is written here from the textbook.

Source: Siciliano, Sciavicco, Villani, Oriolo, Robotics (2009), section 7.3.2, parameters about frames.
"""

import numpy as np

LENGTH, GRAVITY = 0.4, 9.81
TRUTH = {
    "ZZ1": 0.30, "MX1": 0.90, "MY1": 0.05, "M1": 4.0, "ZZ2": 0.08, "MX2": 0.40, "MY2": -0.03, "M2": 2.0,
    "FV1": 1.5, "FC1": 2.0, "OFF1": 0.2, "FV2": 0.6, "FC2": 0.8, "OFF2": -0.1,
}  # fmt: skip  # a table


def description():
    joint = {"type": "revolute", "alpha": 0.0, "r": 0.0, "theta_offset": 0.0, "rotor_inertia": False}
    return {
        "name": "planar arm",
        "joints": [joint | {"d": 0.0}, joint | {"d": LENGTH}],
        "gravity": [0.0, -GRAVITY, 0.0],
    }


def columns(*, seconds=12.0, rate_hz=200.0, noise=0.01, seed=7):
    """Time (s), position (rad), torque (N m) of a motion made of sines; torque noise in N m."""
    time = np.arange(int(seconds * rate_hz)) / rate_hz
    waves = ((0.7, 1.3, 0.1), (0.35, 3.7, 1.9)), ((0.8, 1.9, 0.7), (0.3, 4.3, 2.3))
    position = np.stack([sum(a * np.sin(w * time + p) for a, w, p in joint) for joint in waves], axis=1)
    velocity = np.stack([sum(a * w * np.cos(w * time + p) for a, w, p in joint) for joint in waves], axis=1)
    acceleration = np.stack(
        [sum(-a * w * w * np.sin(w * time + p) for a, w, p in joint) for joint in waves], axis=1
    )
    torque = _torque(position, velocity, acceleration)
    torque += noise * np.random.default_rng(seed).standard_normal(torque.shape)
    return time, position, torque


def csv_log(**options):
    time, position, torque = columns(**options)
    table = np.column_stack([time, position, torque])
    lines = [",".join(f"{value:.7f}" for value in row) for row in table]
    return "\n".join(["time,q_1,q_2,tau_1,tau_2", *lines]).encode()


def _torque(q, dq, ddq):
    t = TRUTH
    c1, s1 = np.cos(q[:, 0]), np.sin(q[:, 0])
    c2, s2 = np.cos(q[:, 1]), np.sin(q[:, 1])
    c12, s12 = np.cos(q.sum(axis=1)), np.sin(q.sum(axis=1))
    coupling = LENGTH * (t["MX2"] * c2 - t["MY2"] * s2)
    swirl = LENGTH * (t["MX2"] * s2 + t["MY2"] * c2)
    h11 = t["ZZ1"] + t["ZZ2"] + t["M2"] * LENGTH**2 + 2 * coupling
    h12 = t["ZZ2"] + coupling
    second = GRAVITY * (t["MX2"] * c12 - t["MY2"] * s12)
    first = GRAVITY * (t["MX1"] * c1 - t["MY1"] * s1 + t["M2"] * LENGTH * c1) + second
    torque = np.stack(
        [
            h11 * ddq[:, 0] + h12 * ddq[:, 1] - swirl * (2 * dq[:, 0] * dq[:, 1] + dq[:, 1] ** 2) + first,
            h12 * ddq[:, 0] + t["ZZ2"] * ddq[:, 1] + swirl * dq[:, 0] ** 2 + second,
        ],
        axis=1,
    )
    for joint in (0, 1):
        number = joint + 1
        torque[:, joint] += t[f"FV{number}"] * dq[:, joint] + t[f"FC{number}"] * np.sign(dq[:, joint])
        torque[:, joint] += t[f"OFF{number}"]
    return torque
