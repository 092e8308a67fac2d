"""Simulate the arm: rigid bodies by pinocchio, drives with offset and set-valued friction.

Coulomb friction at rest is any torque up to the bound, not a sign that flips at every step. One implicit step
therefore asks for the velocity v that minimises v'Av/2 - c'v + sum_j f_j |v_j|, whose optimum sticks exactly
where a real joint does. Sources: Featherstone, Rigid Body Dynamics Algorithms (2008); Stewart & Trinkle,
IJNME 39 (1996), for the implicit step.
"""

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from examples.yumi import arm
from examples.yumi.hidden import NOTHING, Hidden


def pinocchio_model() -> pin.Model:
    """Build the arm: frame j on frame j - 1 at Rx(alpha) Rz(offset), (d, 0, 0) + Rx(alpha) (0, 0, r)."""
    model = pin.Model()
    model.name = "yumi-left"
    model.gravity.linear = arm.GRAVITY
    carrier = 0
    for number, body in enumerate(arm.link_bodies()):
        tilt = pin.utils.rotate("x", float(arm.ALPHA[number]))
        rotation = tilt @ pin.utils.rotate("z", float(arm.THETA_OFFSET[number]))
        translation = np.array([arm.D[number], 0.0, 0.0]) + tilt @ np.array([0.0, 0.0, arm.R[number]])
        placement = pin.SE3(rotation, translation)
        carrier = model.addJoint(carrier, pin.JointModelRZ(), placement, f"joint_{number + 1}")
        inertia = pin.Inertia(body["mass"], np.array(body["centre"]), np.array(body["inertia"]))
        model.appendBodyToJoint(carrier, inertia, pin.SE3.Identity())
    model.armature = arm.ROTOR_INERTIA
    return model


def standard_parameters(model: pin.Model) -> dict[str, float]:
    """List the true standard parameters by name: ten per link, then the drives'."""
    truth: dict[str, float] = {}
    for number in range(1, arm.JOINTS + 1):
        mass, *first, xx, xy, yy, xz, yz, zz = model.inertias[number].toDynamicParameters()
        body = (xx, xy, xz, yy, yz, zz, *first, mass)
        truth |= {f"{symbol}{number}": float(v) for symbol, v in zip(arm.SYMBOLS, body, strict=True)}
    drives = {"IA": arm.ROTOR_INERTIA, "FV": arm.VISCOUS, "FC": arm.COULOMB, "OFF": arm.OFFSET}
    for symbol, values in drives.items():
        truth |= {f"{symbol}{number}": float(value) for number, value in enumerate(values, start=1)}
    return truth


def velocity_under_friction(
    inertia: np.ndarray, impulse: np.ndarray, bound: np.ndarray, guess: np.ndarray
) -> np.ndarray:
    """Minimise v'Av/2 - c'v + sum_j f_j |v_j| over the velocity v.

    Parameters
    ----------
    inertia
        A, symmetric and positive definite.
    impulse
        c.
    bound
        f, the Coulomb friction times the step.
    guess
        The velocity before the step; most steps keep its signs, and then one linear system is all.

    Examples
    --------
    A push below the bound does not move a mass of 1 kg, a push above it does by what is left.

    >>> push = np.array([0.5]), np.array([2.0])
    >>> [float(velocity_under_friction(np.eye(1), c, np.ones(1), np.zeros(1))[0]) for c in push]
    [0.0, 1.0]
    """
    signs = np.sign(guess)
    if signs.all():
        velocity = np.linalg.solve(inertia, impulse - bound * signs)
        if np.array_equal(np.sign(velocity), signs):
            return np.asarray(velocity)
    velocity = guess.copy()
    for _ in range(200):
        before = velocity.copy()
        for joint in range(len(velocity)):
            rest = impulse[joint] - inertia[joint] @ velocity + inertia[joint, joint] * velocity[joint]
            left = max(abs(rest) - bound[joint], 0.0)
            velocity[joint] = np.copysign(left, rest) / inertia[joint, joint]
        if np.abs(velocity - before).max() <= 1e-14:
            break
    moving = velocity != 0.0
    free = np.ix_(moving, moving)
    velocity[moving] = np.linalg.solve(inertia[free], (impulse - bound * np.sign(velocity))[moving])
    return velocity


@dataclass
class Plant:
    """Hold the arm's state and advance it step by step.

    Positions stand at full steps and velocities at half steps (leapfrog), which makes the step second-order
    accurate: M (v+ - v-)/h + bias(q, v) + viscous (v+ + v-)/2 + Coulomb(v+) + offset + ripple(q) = torque.
    The level of Coulomb friction follows the torque that the gears transmitted in the step before.
    """

    model: pin.Model
    position: np.ndarray
    step: float
    hidden: Hidden = NOTHING

    def __post_init__(self) -> None:
        """Start at rest."""
        self.data = self.model.createData()
        self.velocity = np.zeros(arm.JOINTS)
        self.acceleration = np.zeros(arm.JOINTS)
        self.friction = np.zeros(arm.JOINTS)

    def midpoint_velocity(self) -> np.ndarray:
        """Estimate the velocity at the present full step, rad/s, before that step's torque is known."""
        return np.asarray(self.velocity + 0.5 * self.step * self.acceleration)

    def advance(self, torque: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Apply a torque (N m) for one step; give velocity and acceleration at the step's beginning."""
        h = self.step
        inertia = np.array(pin.crba(self.model, self.data, self.position))
        bias = pin.rnea(self.model, self.data, self.position, self.midpoint_velocity(), np.zeros(arm.JOINTS))
        damping = np.diag(0.5 * h * arm.VISCOUS)
        drive = torque - bias - arm.OFFSET - self.hidden.ripple(self.position)
        load = inertia @ self.acceleration - arm.ROTOR_INERTIA * self.acceleration + bias
        bound = h * self.hidden.friction_level(load)
        before = self.velocity
        impulse = (inertia - damping) @ before + h * drive
        self.velocity = velocity_under_friction(inertia + damping, impulse, bound, before)
        self.acceleration = (self.velocity - before) / h
        self.friction = drive - inertia @ self.acceleration
        self.position = self.position + h * self.velocity
        return 0.5 * (before + self.velocity), self.acceleration
