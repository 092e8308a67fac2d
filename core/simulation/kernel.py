"""Compute the mass matrix and the torque of moving masses, compiled, for many states at once.

Everything is written in the base's frame and about its origin: there a subtree's inertia and wrench are plain
sums over its bodies, and one formula serves joints that turn and joints that slide. States are taken in
blocks with the state's index innermost and each loop stores into one table only, which is what the compiler
needs to use vector instructions. Sources: Featherstone 2008, ch. 5 and 6 (recursive Newton-Euler and
composite rigid bodies).
"""

# ruff: noqa: ANN001, PLR0913, PLR0917  # numba: types stand in signatures, tables come singly
# Types stand in numba's signatures, which mypy does not read:
# mypy: disable-error-code="no-untyped-def"

import numpy as np
from numba import njit

from ..regressor.kernel import copy_rows, sine_cosine

BLOCK = 64


@njit(inline="always")
def place_link(
    frame, parent, own, moved, position, joint, begin, count, scale, offset, slides, fixed, shift
) -> None:
    """Write the link's frame in the base's: nine rows of rotation, three of position."""
    f00, f01, f02 = fixed[0, 0], fixed[0, 1], fixed[0, 2]
    f10, f11, f12 = fixed[1, 0], fixed[1, 1], fixed[1, 2]
    f20, f21, f22 = fixed[2, 0], fixed[2, 1], fixed[2, 2]
    t0, t1, t2 = shift[0], shift[1], shift[2]
    for s in range(count):
        coordinate = scale * position[joint, begin + s] + offset
        d, c = sine_cosine((1.0 - slides) * coordinate)
        q = slides * coordinate
        x0, x1, x2 = c * f00 + d * f01, c * f10 + d * f11, c * f20 + d * f21
        y0, y1, y2 = c * f01 - d * f00, c * f11 - d * f10, c * f21 - d * f20
        p0, p1, p2 = t0 + q * f02, t1 + q * f12, t2 + q * f22
        r0, r1, r2 = frame[parent, 0, s], frame[parent, 1, s], frame[parent, 2, s]
        moved[0, s] = r0 * x0 + r1 * x1 + r2 * x2
        moved[1, s] = r0 * y0 + r1 * y1 + r2 * y2
        moved[2, s] = r0 * f02 + r1 * f12 + r2 * f22
        moved[9, s] = frame[parent, 9, s] + r0 * p0 + r1 * p1 + r2 * p2
        r0, r1, r2 = frame[parent, 3, s], frame[parent, 4, s], frame[parent, 5, s]
        moved[3, s] = r0 * x0 + r1 * x1 + r2 * x2
        moved[4, s] = r0 * y0 + r1 * y1 + r2 * y2
        moved[5, s] = r0 * f02 + r1 * f12 + r2 * f22
        moved[10, s] = frame[parent, 10, s] + r0 * p0 + r1 * p1 + r2 * p2
        r0, r1, r2 = frame[parent, 6, s], frame[parent, 7, s], frame[parent, 8, s]
        moved[6, s] = r0 * x0 + r1 * x1 + r2 * x2
        moved[7, s] = r0 * y0 + r1 * y1 + r2 * y2
        moved[8, s] = r0 * f02 + r1 * f12 + r2 * f22
        moved[11, s] = frame[parent, 11, s] + r0 * p0 + r1 * p1 + r2 * p2
    copy_rows(frame, own, moved, 12, count)


@njit(inline="always")
def place_axis(axis, frame, own, turns, slides, count) -> None:
    """Write what a unit of joint speed gives: spin, and speed of the point at the base's origin."""
    for s in range(count):
        z0, z1, z2 = frame[own, 2, s], frame[own, 5, s], frame[own, 8, s]
        p0, p1, p2 = frame[own, 9, s], frame[own, 10, s], frame[own, 11, s]
        axis[own, 0, s], axis[own, 1, s], axis[own, 2, s] = turns * z0, turns * z1, turns * z2
        axis[own, 3, s] = turns * (p1 * z2 - p2 * z1) + slides * z0
        axis[own, 4, s] = turns * (p2 * z0 - p0 * z2) + slides * z1
        axis[own, 5, s] = turns * (p0 * z1 - p1 * z0) + slides * z2


@njit(inline="always")
def move_link(motion, parent, own, moved, axis, velocity, acceleration, joint, begin, count) -> None:
    """Carry spin, origin's speed, and the rates of both less gravity (three rows each) one link outwards."""
    for s in range(count):
        v, a = velocity[joint, begin + s], acceleration[joint, begin + s]
        x0, x1, x2 = axis[own, 0, s], axis[own, 1, s], axis[own, 2, s]
        y0, y1, y2 = axis[own, 3, s], axis[own, 4, s], axis[own, 5, s]
        w0, w1, w2 = motion[parent, 0, s], motion[parent, 1, s], motion[parent, 2, s]
        u0, u1, u2 = motion[parent, 3, s], motion[parent, 4, s], motion[parent, 5, s]
        moved[0, s], moved[1, s], moved[2, s] = w0 + v * x0, w1 + v * x1, w2 + v * x2
        moved[3, s], moved[4, s], moved[5, s] = u0 + v * y0, u1 + v * y1, u2 + v * y2
        moved[6, s] = motion[parent, 6, s] + a * x0 + v * (w1 * x2 - w2 * x1)
        moved[7, s] = motion[parent, 7, s] + a * x1 + v * (w2 * x0 - w0 * x2)
        moved[8, s] = motion[parent, 8, s] + a * x2 + v * (w0 * x1 - w1 * x0)
        moved[9, s] = motion[parent, 9, s] + a * y0 + v * (w1 * y2 - w2 * y1 + u1 * x2 - u2 * x1)
        moved[10, s] = motion[parent, 10, s] + a * y1 + v * (w2 * y0 - w0 * y2 + u2 * x0 - u0 * x2)
        moved[11, s] = motion[parent, 11, s] + a * y2 + v * (w0 * y1 - w1 * y0 + u0 * x1 - u1 * x0)
    copy_rows(motion, own, moved, 12, count)


@njit(inline="always")
def place_body(body, frame, own, bodies, count) -> None:
    """Write a body's inertia about the base's origin (XX XY XZ YY YZ ZZ) and its first moments."""
    xx, xy, xz, yy, yz, zz = bodies[0], bodies[1], bodies[2], bodies[3], bodies[4], bodies[5]
    mx, my, mz, m = bodies[6], bodies[7], bodies[8], bodies[9]
    for s in range(count):
        r00, r01, r02 = frame[own, 0, s], frame[own, 1, s], frame[own, 2, s]
        r10, r11, r12 = frame[own, 3, s], frame[own, 4, s], frame[own, 5, s]
        r20, r21, r22 = frame[own, 6, s], frame[own, 7, s], frame[own, 8, s]
        p0, p1, p2 = frame[own, 9, s], frame[own, 10, s], frame[own, 11, s]
        h0, h1, h2 = (
            r00 * mx + r01 * my + r02 * mz,
            r10 * mx + r11 * my + r12 * mz,
            r20 * mx + r21 * my + r22 * mz,
        )
        # half of m p p' belongs to each side of h p' + p h'
        g0, g1, g2 = h0 + 0.5 * m * p0, h1 + 0.5 * m * p1, h2 + 0.5 * m * p2
        a0, a1, a2 = (
            r00 * xx + r01 * xy + r02 * xz,
            r00 * xy + r01 * yy + r02 * yz,
            r00 * xz + r01 * yz + r02 * zz,
        )
        b0, b1, b2 = (
            r10 * xx + r11 * xy + r12 * xz,
            r10 * xy + r11 * yy + r12 * yz,
            r10 * xz + r11 * yz + r12 * zz,
        )
        c0, c1, c2 = (
            r20 * xx + r21 * xy + r22 * xz,
            r20 * xy + r21 * yy + r22 * yz,
            r20 * xz + r21 * yz + r22 * zz,
        )
        e0, e1, e2 = 2.0 * g0 * p0, 2.0 * g1 * p1, 2.0 * g2 * p2
        body[own, 0, s] = a0 * r00 + a1 * r01 + a2 * r02 + e1 + e2
        body[own, 1, s] = a0 * r10 + a1 * r11 + a2 * r12 - g0 * p1 - g1 * p0
        body[own, 2, s] = a0 * r20 + a1 * r21 + a2 * r22 - g0 * p2 - g2 * p0
        body[own, 3, s] = b0 * r10 + b1 * r11 + b2 * r12 + e0 + e2
        body[own, 4, s] = b0 * r20 + b1 * r21 + b2 * r22 - g1 * p2 - g2 * p1
        body[own, 5, s] = c0 * r20 + c1 * r21 + c2 * r22 + e0 + e1
        body[own, 6, s], body[own, 7, s], body[own, 8, s] = h0 + m * p0, h1 + m * p1, h2 + m * p2


@njit(inline="always")
def load_link(wrench, motion, body, own, mass, count) -> None:
    """Write the moment and the force that a body's motion asks for: I A + V x* (I V)."""
    for s in range(count):
        xx, xy, xz = body[own, 0, s], body[own, 1, s], body[own, 2, s]
        yy, yz, zz = body[own, 3, s], body[own, 4, s], body[own, 5, s]
        h0, h1, h2 = body[own, 6, s], body[own, 7, s], body[own, 8, s]
        w0, w1, w2 = motion[own, 0, s], motion[own, 1, s], motion[own, 2, s]
        u0, u1, u2 = motion[own, 3, s], motion[own, 4, s], motion[own, 5, s]
        e0, e1, e2 = motion[own, 6, s], motion[own, 7, s], motion[own, 8, s]
        a0, a1, a2 = motion[own, 9, s], motion[own, 10, s], motion[own, 11, s]
        k0 = xx * w0 + xy * w1 + xz * w2 + h1 * u2 - h2 * u1
        k1 = xy * w0 + yy * w1 + yz * w2 + h2 * u0 - h0 * u2
        k2 = xz * w0 + yz * w1 + zz * w2 + h0 * u1 - h1 * u0
        l0 = mass * u0 + w1 * h2 - w2 * h1
        l1 = mass * u1 + w2 * h0 - w0 * h2
        l2 = mass * u2 + w0 * h1 - w1 * h0
        wrench[own, 0, s] = (
            xx * e0 + xy * e1 + xz * e2 + h1 * a2 - h2 * a1 + w1 * k2 - w2 * k1 + u1 * l2 - u2 * l1
        )
        wrench[own, 1, s] = (
            xy * e0 + yy * e1 + yz * e2 + h2 * a0 - h0 * a2 + w2 * k0 - w0 * k2 + u2 * l0 - u0 * l2
        )
        wrench[own, 2, s] = (
            xz * e0 + yz * e1 + zz * e2 + h0 * a1 - h1 * a0 + w0 * k1 - w1 * k0 + u0 * l1 - u1 * l0
        )
        wrench[own, 3, s] = mass * a0 + e1 * h2 - e2 * h1 + w1 * l2 - w2 * l1
        wrench[own, 4, s] = mass * a1 + e2 * h0 - e0 * h2 + w2 * l0 - w0 * l2
        wrench[own, 5, s] = mass * a2 + e0 * h1 - e1 * h0 + w0 * l1 - w1 * l0


@njit(inline="always")
def gather(table, parent, own, rows, count) -> None:
    """Add a link's rows to its antecedent's."""
    for row in range(rows):
        for s in range(count):
            table[parent, row, s] += table[own, row, s]


@njit(inline="always")
def _momentum(pushed, body, axis, own, mass, count) -> None:
    """Write the momentum that a unit of joint speed gives the subtree: three rows angular, three linear."""
    for s in range(count):
        h0, h1, h2 = body[own, 6, s], body[own, 7, s], body[own, 8, s]
        x0, x1, x2 = axis[own, 0, s], axis[own, 1, s], axis[own, 2, s]
        y0, y1, y2 = axis[own, 3, s], axis[own, 4, s], axis[own, 5, s]
        pushed[0, s] = body[own, 0, s] * x0 + body[own, 1, s] * x1 + body[own, 2, s] * x2 + h1 * y2 - h2 * y1
        pushed[1, s] = body[own, 1, s] * x0 + body[own, 3, s] * x1 + body[own, 4, s] * x2 + h2 * y0 - h0 * y2
        pushed[2, s] = body[own, 2, s] * x0 + body[own, 4, s] * x1 + body[own, 5, s] * x2 + h0 * y1 - h1 * y0
        pushed[3, s] = mass * y0 + x1 * h2 - x2 * h1
        pushed[4, s] = mass * y1 + x2 * h0 - x0 * h2
        pushed[5, s] = mass * y2 + x0 * h1 - x1 * h0


@njit(inline="always")
def _project(out, row, axis, link, rows, begin, count) -> None:
    """Add a wrench or momentum, seen along a joint's axis, to a row of the output."""
    for s in range(count):
        out[row, begin + s] += (
            axis[link, 0, s] * rows[0, s]
            + axis[link, 1, s] * rows[1, s]
            + axis[link, 2, s] * rows[2, s]
            + axis[link, 3, s] * rows[3, s]
            + axis[link, 4, s] * rows[4, s]
            + axis[link, 5, s] * rows[5, s]
        )


TABLE = "float64[:,::1]"
ROBOT = (
    "Tuple((boolean[::1], int64[::1], int64[::1], float64[::1], float64[::1], float64[:,:,::1],"
    " float64[:,::1], float64[::1], float64[:,::1], float64[::1]))"
)
"""What the kernels need of a robot: see `Mechanism.robot`."""
OPTIONS = {
    "nogil": True,
    "cache": True,
    "no_cfunc_wrapper": True,
    "fastmath": {"contract", "nsz", "arcp"},
    "error_model": "numpy",
}


@njit(inline="always")
def scratch_of(links, gravity, block) -> tuple[np.ndarray, ...]:
    """Give the tables that a block of states needs: frames, axes, motions, bodies, wrenches, moved rows."""
    frame, motion = np.zeros((links + 1, 12, block)), np.zeros((links + 1, 12, block))
    frame[0, 0], frame[0, 4], frame[0, 8] = 1.0, 1.0, 1.0
    for k in range(3):
        motion[0, 9 + k] = -gravity[k]
    return (
        frame,
        np.zeros((links + 1, 6, block)),
        motion,
        np.zeros((links + 1, 9, block)),
        np.zeros((links + 1, 6, block)),
        np.zeros((12, block)),
    )


@njit(inline="always")
def torque_of_block(joint, axis, wrench, torque, begin, count) -> None:
    """Add the joints' torques of a block that has been moved."""
    for j in range(len(joint)):
        own = np.uintp(j + 1)
        _project(torque, np.uintp(joint[j]), axis, own, wrench[own], begin, count)


@njit(inline="always")
def mass_of_block(antecedent, joint, masses, axis, body, pushed, mass, joints, begin, count) -> None:
    """Add the lower triangle of the mass matrix of a block that has been moved, row i * joints + j."""
    for j in range(len(joint)):
        _momentum(pushed, body, axis, np.uintp(j + 1), masses[j], count)
        carrier = j + 1
        while carrier > 0:
            one, other = joint[carrier - 1], joint[j]
            row = np.uintp(max(one, other) * joints + min(one, other))
            # two links that move with one joint meet twice on its diagonal: i with j, and j with i
            for _ in range(2 if one == other and carrier != j + 1 else 1):
                _project(mass, row, axis, np.uintp(carrier), pushed, begin, count)
            carrier = antecedent[carrier - 1]


@njit(f"void({ROBOT}, {TABLE}, {TABLE}, {TABLE}, {TABLE}, {TABLE})", **OPTIONS)
def move_masses(  # pragma: no cover  (compiled)
    robot, position, velocity, acceleration, torque, mass
) -> None:
    """Add torque and the mass matrix's lower triangle (row i * joints + j) of every state to two tables.

    All tables are (rows, states); an empty one gets nothing. Each block goes from the base outwards and back,
    and sums subtrees. Scratch tables are made here, so that the compiler knows that they are apart.
    """
    prismatic, antecedent, joint, ratio, offset, rotation, translation, gravity, bodies, masses = robot
    joints, states = position.shape
    frame, axis, motion, body, wrench, moved = scratch_of(len(antecedent), gravity, BLOCK)
    for begin in range(0, states, BLOCK):
        start, count = np.uintp(begin), np.uintp(min(BLOCK, states - begin))
        for j in range(len(antecedent)):
            own, parent, drive = np.uintp(j + 1), np.uintp(antecedent[j]), np.uintp(joint[j])
            scale, zero, slides = ratio[j], offset[j], 1.0 if prismatic[j] else 0.0
            fixed, shift = rotation[j], translation[j]
            place_link(
                frame, parent, own, moved, position, drive, start, count, scale, zero, slides, fixed, shift
            )
            place_axis(axis, frame, own, scale * (1.0 - slides), scale * slides, count)
            move_link(motion, parent, own, moved, axis, velocity, acceleration, drive, start, count)
            place_body(body, frame, own, bodies[j], count)
            load_link(wrench, motion, body, own, bodies[j, 9], count)
        for j in range(len(antecedent) - 1, -1, -1):
            if antecedent[j] > 0:
                own, parent = np.uintp(j + 1), np.uintp(antecedent[j])
                gather(wrench, parent, own, np.uintp(6), count)
                gather(body, parent, own, np.uintp(9), count)
        if len(torque):
            torque_of_block(joint, axis, wrench, torque, start, count)
        if len(mass):
            mass_of_block(antecedent, joint, masses, axis, body, moved, mass, joints, start, count)
