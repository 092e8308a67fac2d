"""Compute joint torque by the recursive Newton-Euler algorithm for whole arrays of samples.

This is the reference for tests of the compiled regressor, with which it shares no formula beyond the laws of
mechanics. Sources: Luh, Walker & Paul 1980; Khalil & Dombre (2002), ch. 9.
"""

import numpy as np

from ..arrays import JointSeries, LinkTable
from ..robot.inertia import inertia_about_origin
from ..robot.model import Link, RobotModel
from ..signals.state import MotionState

_Z = np.array([0.0, 0.0, 1.0])


def inverse_dynamics(robot: RobotModel, links: LinkTable, state: MotionState) -> JointSeries:
    """Give the torque that moves the links, without rotor inertia and friction.

    Parameters
    ----------
    links
        Ten inertial parameters per link about its frame's origin (kg m2, kg m, kg).
    state
        The motion of the joint coordinates.

    Returns
    -------
    JointSeries
        Torque in N m (revolute) or N (prismatic).
    """
    poses = [_pose(link, state) for link in robot.links]
    spins = _spins(robot, poses, state)
    wrenches = [_wrench(_inertias(body), *spin) for body, spin in zip(links, spins, strict=True)]
    forces, moments = [force for force, _ in wrenches], [moment for _, moment in wrenches]
    torque = np.zeros_like(state.position, dtype=float)
    for index in range(len(robot.links) - 1, -1, -1):
        link, (rotation, shift) = robot.links[index], poses[index]
        carried = moments[index] if link.kind == "revolute" else forces[index]
        torque[:, link.joint - 1] += link.ratio * carried[:, 2]
        if link.antecedent:
            force = np.einsum("sij,sj->si", rotation, forces[index])
            forces[link.antecedent - 1] += force
            moments[link.antecedent - 1] += np.einsum("sij,sj->si", rotation, moments[index]) + _cross(
                shift, force
            )
    return torque


def unit_torques(robot: RobotModel, number: int, state: MotionState) -> np.ndarray:
    """Give the torque per unit of each of one link's inertial parameters, the others' being zero.

    Only the links that carry it are traversed, with all ten unit bodies at once.

    Parameters
    ----------
    number
        The link's, from 1.

    Returns
    -------
    numpy.ndarray
        Parameters x samples x joints, N m (revolute) or N (prismatic) per kg m2, kg m, kg.
    """
    poses = [_pose(link, state) for link in robot.links]
    spin = _spins(robot, poses, state)[number - 1]
    inertia, first, mass = (np.stack(parts) for parts in zip(*map(_inertias, np.eye(10)), strict=True))
    wrenches = _wrench((inertia, first[:, None], mass[:, None, None]), *spin)
    force, moment = (np.ascontiguousarray(part.transpose(1, 2, 0)) for part in wrenches)
    torque = np.zeros((10, *state.position.shape))
    while number:
        link, (rotation, shift) = robot.links[number - 1], poses[number - 1]
        carried = moment if link.kind == "revolute" else force
        torque[:, :, link.joint - 1] += link.ratio * carried[:, 2].T
        force, moment = rotation @ force, rotation @ moment
        moment += _cross(shift[:, :, None], force, axis=1)
        number = link.antecedent
    return torque


def _spins(
    robot: RobotModel, poses: list[tuple[np.ndarray, np.ndarray]], state: MotionState
) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Give every link's angular velocity, its rate, and its origin's acceleration less gravity's."""
    still = np.zeros((len(state.position), 3))
    base = (still, still, np.tile(-np.asarray(robot.gravity, float), (len(still), 1)))
    spins: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    for link, pose in zip(robot.links, poses, strict=True):
        before = spins[link.antecedent - 1] if link.antecedent else base
        spins.append(_advance(link, pose, before, state))
    return spins


def _pose(link: Link, state: MotionState) -> tuple[np.ndarray, np.ndarray]:
    coordinate = link.ratio * state.position[:, link.joint - 1] + link.offset
    samples = len(coordinate)
    if link.kind == "prismatic":
        shift = link.translation + coordinate[:, None] * link.rotation[:, 2]
        return np.broadcast_to(link.rotation, (samples, 3, 3)), shift
    turn = np.zeros((samples, 3, 3))
    turn[:, 0, 0] = turn[:, 1, 1] = np.cos(coordinate)
    turn[:, 1, 0] = np.sin(coordinate)
    turn[:, 0, 1] = -turn[:, 1, 0]
    turn[:, 2, 2] = 1.0
    return link.rotation @ turn, np.broadcast_to(link.translation, (samples, 3))


def _advance(
    link: Link,
    pose: tuple[np.ndarray, np.ndarray],
    before: tuple[np.ndarray, np.ndarray, np.ndarray],
    state: MotionState,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    rotation, shift = pose
    spin, spin_rate, acceleration = before
    speed = link.ratio * state.velocity[:, link.joint - 1, None] * _Z
    speed_rate = link.ratio * state.acceleration[:, link.joint - 1, None] * _Z
    carried = acceleration + _cross(spin_rate, shift) + _cross(spin, _cross(spin, shift))
    spin, spin_rate, carried = (np.einsum("sij,si->sj", rotation, v) for v in (spin, spin_rate, carried))
    if link.kind == "revolute":
        return spin + speed, spin_rate + speed_rate + _cross(spin, speed), carried
    return spin, spin_rate, carried + speed_rate + 2.0 * _cross(spin, speed)


def _inertias(body: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Give a body's inertia about the frame's origin, its first moments and its mass."""
    return inertia_about_origin(body), body[6:9], body[9]


def _wrench(
    body: tuple[np.ndarray, np.ndarray, np.ndarray],
    spin: np.ndarray,
    spin_rate: np.ndarray,
    acceleration: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    inertia, first, mass = body
    force = mass * acceleration + _cross(spin_rate, first) + _cross(spin, _cross(spin, first))
    moment = spin_rate @ inertia + _cross(spin, spin @ inertia) + _cross(first, acceleration)
    return force, moment


def _cross(one: np.ndarray, other: np.ndarray, axis: int = -1) -> np.ndarray:
    """Give the vector product along an axis, digit by digit that of `numpy.cross`, without its preparations.

    They take longer than the product of some hundred vectors.
    """
    one, other = one.swapaxes(axis, -1), other.swapaxes(axis, -1)
    product = np.empty(np.broadcast_shapes(one.shape, other.shape))
    for index in range(3):
        after, before = (index + 1) % 3, (index + 2) % 3
        np.multiply(one[..., after], other[..., before], out=product[..., index])
        product[..., index] -= one[..., before] * other[..., after]
    return product.swapaxes(axis, -1)
