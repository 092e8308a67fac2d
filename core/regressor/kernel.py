"""Compute the rigid body's regressor, compiled: torque per unit inertial parameter on every carrying joint.

Each link's six-by-ten force map is written in the link's own frame and projected on the axes of the joints
that carry it, which are themselves carried outwards link by link; no six-by-six transform appears. Samples
are taken in blocks small enough for the nearest caches, with the sample index innermost so that the compiler
can use vector instructions. It does so only where a loop stores into one table and reads others, where what
its turns share stands in local numbers, and where indices are unsigned (a signed one may count from the end);
each loop below is written to that rule, and sine and cosine are series for the same reason. Sources:
Atkeson, An & Hollerbach 1986 (linearity); Khalil & Dombre (2002), ch. 9.
"""

# ruff: noqa: ANN001, PLR0913, PLR0917  # numba: types stand in signatures, tables come singly
# Types stand in numba's signatures, which mypy does not read:
# mypy: disable-error-code="no-untyped-def"

from math import factorial

import numpy as np
from numba import njit

BLOCK = 64
TWO_OVER_PI = 2.0 / np.pi
HALF_PI_HIGH = float.fromhex("0x1.921fb544p+0")
"""Half of pi to 33 bits, so that its product with a count of quarter turns is exact; the rest follows."""
HALF_PI_LOW = float.fromhex("0x1.0b4611a626331p-34")
S3, S5, S7, S9, S11, S13, S15, S17 = ((-1.0) ** k / factorial(2 * k + 1) for k in range(1, 9))
C2, C4, C6, C8, C10, C12, C14, C16 = ((-1.0) ** k / factorial(2 * k) for k in range(1, 9))

_SIGNATURE = (
    "void(float64[:,::1], float64[:,::1], float64[:,::1], boolean[::1], int64[::1], int64[::1], float64[::1],"
    " float64[::1], float64[:,:,::1], float64[:,::1], float64[::1], int64[::1], int64[::1], int64[:,::1],"
    " float64[:,::1])"
)


@njit(inline="always")
def sine_cosine(angle) -> tuple[float, float]:
    """Give sine and cosine to rounding, for angles up to a million radians, by series that vectorise."""
    quarters = np.floor(angle * TWO_OVER_PI + 0.5)
    x = (angle - quarters * HALF_PI_HIGH) - quarters * HALF_PI_LOW
    z = x * x
    sine = x + x * z * (S3 + z * (S5 + z * (S7 + z * (S9 + z * (S11 + z * (S13 + z * (S15 + z * S17)))))))
    cosine = 1.0 + z * (C2 + z * (C4 + z * (C6 + z * (C8 + z * (C10 + z * (C12 + z * (C14 + z * C16)))))))
    turn = quarters - 4.0 * np.floor(0.25 * quarters)
    first, second = (sine, cosine) if turn - 2.0 * np.floor(0.5 * turn) == 0.0 else (cosine, sine)
    return (-first if turn >= 2.0 else first), (-second if abs(turn - 1.5) < 1.0 else second)


@njit(inline="always")
def _place_link(pose, position, joint, begin, count, scale, offset, slides, rotation, translation) -> None:
    """Write the link's frame in its antecedent's: nine rows of rotation, three of position."""
    r00, r01, r02 = rotation[0, 0], rotation[0, 1], rotation[0, 2]
    r10, r11, r12 = rotation[1, 0], rotation[1, 1], rotation[1, 2]
    r20, r21, r22 = rotation[2, 0], rotation[2, 1], rotation[2, 2]
    t0, t1, t2 = translation[0], translation[1], translation[2]
    for s in range(count):
        coordinate = scale * position[joint, begin + s] + offset
        d, c = sine_cosine((1.0 - slides) * coordinate)
        q = slides * coordinate
        pose[0, s], pose[1, s], pose[2, s] = c * r00 + d * r01, c * r01 - d * r00, r02
        pose[3, s], pose[4, s], pose[5, s] = c * r10 + d * r11, c * r11 - d * r10, r12
        pose[6, s], pose[7, s], pose[8, s] = c * r20 + d * r21, c * r21 - d * r20, r22
        pose[9, s], pose[10, s], pose[11, s] = t0 + q * r02, t1 + q * r12, t2 + q * r22


@njit(inline="always")
def copy_rows(table, index, rows, many, count) -> None:
    """Copy rows into a table; a loop that read and wrote the same table would not be vectorised."""
    for row in range(many):
        for s in range(count):
            table[index, row, s] = rows[row, s]


@njit(inline="always")
def _move_link(
    motion, parent, own, pose, velocity, acceleration, joint, begin, moved, count, turns, slides
) -> None:
    """Carry spin, its rate and the origin's acceleration less gravity (three rows each) one link outwards."""
    for s in range(count):
        p0, p1, p2 = pose[9, s], pose[10, s], pose[11, s]
        w0, w1, w2 = motion[parent, 0, s], motion[parent, 1, s], motion[parent, 2, s]
        e0, e1, e2 = motion[parent, 3, s], motion[parent, 4, s], motion[parent, 5, s]
        wp = w0 * p0 + w1 * p1 + w2 * p2
        ww = w0 * w0 + w1 * w1 + w2 * w2
        a0 = motion[parent, 6, s] + e1 * p2 - e2 * p1 + w0 * wp - p0 * ww
        a1 = motion[parent, 7, s] + e2 * p0 - e0 * p2 + w1 * wp - p1 * ww
        a2 = motion[parent, 8, s] + e0 * p1 - e1 * p0 + w2 * wp - p2 * ww
        v, dv = velocity[joint, begin + s], acceleration[joint, begin + s]
        u0 = pose[0, s] * w0 + pose[3, s] * w1 + pose[6, s] * w2
        u1 = pose[1, s] * w0 + pose[4, s] * w1 + pose[7, s] * w2
        u2 = pose[2, s] * w0 + pose[5, s] * w1 + pose[8, s] * w2
        moved[0, s] = u0
        moved[1, s] = u1
        moved[2, s] = u2 + turns * v
        moved[3, s] = pose[0, s] * e0 + pose[3, s] * e1 + pose[6, s] * e2 + turns * (u1 * v)
        moved[4, s] = pose[1, s] * e0 + pose[4, s] * e1 + pose[7, s] * e2 - turns * (u0 * v)
        moved[5, s] = pose[2, s] * e0 + pose[5, s] * e1 + pose[8, s] * e2 + turns * dv
        moved[6, s] = pose[0, s] * a0 + pose[3, s] * a1 + pose[6, s] * a2 + slides * (2.0 * u1 * v)
        moved[7, s] = pose[1, s] * a0 + pose[4, s] * a1 + pose[7, s] * a2 - slides * (2.0 * u0 * v)
        moved[8, s] = pose[2, s] * a0 + pose[5, s] * a1 + pose[8, s] * a2 + slides * dv
    copy_rows(motion, own, moved, 9, count)


@njit(inline="always")
def _map_forces(effect, motion, own, count) -> None:
    """Write what one unit of each parameter asks for: 18 rows of moment (XX..ZZ), 9 of force (MX..MZ)."""
    for s in range(count):
        w0, w1, w2 = motion[own, 0, s], motion[own, 1, s], motion[own, 2, s]
        e0, e1, e2 = motion[own, 3, s], motion[own, 4, s], motion[own, 5, s]
        xx, yy, zz = w0 * w0, w1 * w1, w2 * w2
        xy, xz, yz = w0 * w1, w0 * w2, w1 * w2
        effect[0, s], effect[1, s], effect[2, s] = e0, xz, -xy
        effect[3, s], effect[4, s], effect[5, s] = e1 - xz, e0 + yz, xx - yy
        effect[6, s], effect[7, s], effect[8, s] = e2 + xy, zz - xx, e0 - yz
        effect[9, s], effect[10, s], effect[11, s] = -yz, e1, xy
        effect[12, s], effect[13, s], effect[14, s] = yy - zz, e2 - xy, e1 + xz
        effect[15, s], effect[16, s], effect[17, s] = yz, -xz, e2
        effect[18, s], effect[19, s], effect[20, s] = -(yy + zz), xy + e2, xz - e1
        effect[21, s], effect[22, s], effect[23, s] = xy - e2, -(xx + zz), yz + e0
        effect[24, s], effect[25, s], effect[26, s] = xz + e1, yz - e0, -(xx + yy)


@njit(inline="always")
def _move_axis(axis, inner, outer, pose, moved, count) -> None:
    """Write a carrying joint's axis (three rows of direction, three of moment) in the next link's frame."""
    for s in range(count):
        p0, p1, p2 = pose[9, s], pose[10, s], pose[11, s]
        x0, x1, x2 = axis[inner, 0, s], axis[inner, 1, s], axis[inner, 2, s]
        y0 = axis[inner, 3, s] + x1 * p2 - x2 * p1
        y1 = axis[inner, 4, s] + x2 * p0 - x0 * p2
        y2 = axis[inner, 5, s] + x0 * p1 - x1 * p0
        moved[0, s] = pose[0, s] * x0 + pose[3, s] * x1 + pose[6, s] * x2
        moved[1, s] = pose[1, s] * x0 + pose[4, s] * x1 + pose[7, s] * x2
        moved[2, s] = pose[2, s] * x0 + pose[5, s] * x1 + pose[8, s] * x2
        moved[3, s] = pose[0, s] * y0 + pose[3, s] * y1 + pose[6, s] * y2
        moved[4, s] = pose[1, s] * y0 + pose[4, s] * y1 + pose[7, s] * y2
        moved[5, s] = pose[2, s] * y0 + pose[5, s] * y1 + pose[8, s] * y2
    copy_rows(axis, outer, moved, 6, count)


@njit(inline="always")
def _project(torque, axis, pair, effect, motion, own, count) -> None:
    """Write the torque on one carrying joint per unit of each of the link's ten parameters."""
    for s in range(count):
        x0, x1, x2 = axis[pair, 0, s], axis[pair, 1, s], axis[pair, 2, s]
        y0, y1, y2 = axis[pair, 3, s], axis[pair, 4, s], axis[pair, 5, s]
        a0, a1, a2 = motion[own, 6, s], motion[own, 7, s], motion[own, 8, s]
        torque[0, s] = x0 * effect[0, s] + x1 * effect[1, s] + x2 * effect[2, s]
        torque[1, s] = x0 * effect[3, s] + x1 * effect[4, s] + x2 * effect[5, s]
        torque[2, s] = x0 * effect[6, s] + x1 * effect[7, s] + x2 * effect[8, s]
        torque[3, s] = x0 * effect[9, s] + x1 * effect[10, s] + x2 * effect[11, s]
        torque[4, s] = x0 * effect[12, s] + x1 * effect[13, s] + x2 * effect[14, s]
        torque[5, s] = x0 * effect[15, s] + x1 * effect[16, s] + x2 * effect[17, s]
        # the origin's acceleration acts on the lever: x (e_k x a) = e_k (a x x)
        torque[6, s] = x2 * a1 - x1 * a2 + y0 * effect[18, s] + y1 * effect[19, s] + y2 * effect[20, s]
        torque[7, s] = x0 * a2 - x2 * a0 + y0 * effect[21, s] + y1 * effect[22, s] + y2 * effect[23, s]
        torque[8, s] = x1 * a0 - x0 * a1 + y0 * effect[24, s] + y1 * effect[25, s] + y2 * effect[26, s]
        torque[9, s] = y0 * a0 + y1 * a1 + y2 * a2


@njit(inline="always")
def _add(out, slots, torque, scale, begin, count) -> None:
    """Add the wanted rows to the output."""
    for k in range(10):
        if slots[k] >= 0:
            target = np.uintp(slots[k])
            for s in range(count):
                out[target, begin + s] += scale * torque[k, s]


@njit(
    _SIGNATURE,
    nogil=True,
    cache=True,
    no_cfunc_wrapper=True,
    fastmath={"contract", "nsz", "arcp"},
    error_model="numpy",
)
def rigid_body_series(  # pragma: no cover  (compiled)
    position,
    velocity,
    acceleration,
    prismatic,
    antecedent,
    joint,
    ratio,
    offset,
    rotation,
    translation,
    gravity,
    chain_start,
    chain,
    slot,
    out,
) -> None:
    """Add to `out[slot[pair, k]]` the torque on a carrying joint per unit parameter k of a link.

    `position`, `velocity`, `acceleration` are (joints, samples); pairs run over links and, within a link,
    over its chain from the base outwards; `slot` is -1 where the series is not wanted. Where two carriers
    move with the same joint their series add up, so `out` must come in as zeros.
    """
    links = len(antecedent)
    samples = position.shape[1]
    pose = np.empty((12, BLOCK))
    motion = np.zeros((links + 1, 9, BLOCK))
    axis = np.zeros((len(chain), 6, BLOCK))
    effect = np.empty((27, BLOCK))
    moved = np.empty((9, BLOCK))
    torque = np.empty((10, BLOCK))
    for k in range(3):
        motion[0, 6 + k] = -gravity[k]
    for j in range(links):
        axis[chain_start[j + 1] - 1, 5 if prismatic[j] else 2] = 1.0
    for begin in range(0, samples, BLOCK):
        start, count = np.uintp(begin), np.uintp(min(BLOCK, samples - begin))
        for j in range(links):
            own, parent = np.uintp(j + 1), np.uintp(antecedent[j])
            slides = 1.0 if prismatic[j] else 0.0
            first, last = chain_start[j], chain_start[j + 1] - 1
            above = chain_start[antecedent[j] - 1]
            _place_link(
                pose,
                position,
                np.uintp(joint[j]),
                start,
                count,
                ratio[j],
                offset[j],
                slides,
                rotation[j],
                translation[j],
            )
            _move_link(
                motion,
                parent,
                own,
                pose,
                velocity,
                acceleration,
                np.uintp(joint[j]),
                start,
                moved,
                count,
                ratio[j] * (1.0 - slides),
                ratio[j] * slides,
            )
            _map_forces(effect, motion, own, count)
            for k in range(last - first):
                _move_axis(axis, np.uintp(above + k), np.uintp(first + k), pose, moved, count)
            for pair in range(first, last + 1):
                _project(torque, axis, np.uintp(pair), effect, motion, own, count)
                _add(out, slot[pair], torque, ratio[chain[pair]], start, count)
