"""Compute the rigid body's regressor, compiled: torque per unit inertial parameter for every joint that carries the link.

Each link's six-by-ten force map is written in the link's own frame and projected on the axes of the joints
that carry it, which are themselves carried outwards link by link; no six-by-six transform appears. Samples
are taken in blocks small enough for the first-level cache, with the sample index innermost so that the
compiler can use vector instructions. Sources: Atkeson, An & Hollerbach 1986 (linearity); Khalil & Dombre
(2002), ch. 9.
"""

import numpy as np
from numba import njit

BLOCK = 32

_SIGNATURE = (
    "void(float64[:,::1], float64[:,::1], float64[:,::1], float64[:,::1], float64[:,::1], boolean[::1], int64[::1],"
    " int64[::1], float64[::1], float64[:,:,::1], float64[:,::1], float64[::1], int64[::1], int64[::1], int64[:,::1],"
    " float64[:,::1])"
)


@njit(_SIGNATURE, nogil=True, cache=True, fastmath={"contract", "nsz", "arcp"}, error_model="numpy")
def rigid_body_series(  # pragma: no cover  (compiled)  # noqa: PLR0912, PLR0913, PLR0915, C901
    cosine,
    sine,
    stroke,
    velocity,
    acceleration,
    prismatic,
    antecedent,
    joint,
    ratio,
    rotation,
    translation,
    gravity,
    chain_start,
    chain,
    slot,
    out,
):
    """Fill `out[slot[pair, k]]` with the torque on a carrying joint per unit parameter k of a link.

    `cosine`, `sine`, `stroke` are (links, samples); `velocity`, `acceleration` are (joints, samples); pairs
    run over links and, within a link, over its chain from the base outwards; `slot` is -1 where the series is
    not wanted. Where two carriers move with the same joint their series add up, so `out` must come in as
    zeros.
    """
    links = len(antecedent)
    samples = cosine.shape[1]
    pairs = len(chain)
    turn = np.empty((9, BLOCK))
    spin = np.empty((links, 3, BLOCK))
    rate = np.empty((links, 3, BLOCK))
    push = np.empty((links, 3, BLOCK))
    axis = np.empty((pairs, 6, BLOCK))
    map_moment = np.empty((18, BLOCK))
    map_force = np.empty((9, BLOCK))
    for begin in range(0, samples, BLOCK):
        count = min(BLOCK, samples - begin)
        for j in range(links):
            a = antecedent[j] - 1
            mine = joint[j]
            scale = ratio[j]
            slides = prismatic[j]
            r = rotation[j]
            t0, t1, t2 = translation[j, 0], translation[j, 1], translation[j, 2]
            for s in range(count):
                c, d = cosine[j, begin + s], sine[j, begin + s]
                for row in range(3):
                    turn[3 * row, s] = c * r[row, 0] + d * r[row, 1]
                    turn[3 * row + 1, s] = c * r[row, 1] - d * r[row, 0]
                    turn[3 * row + 2, s] = r[row, 2]
            for s in range(count):
                q = stroke[j, begin + s]
                p0, p1, p2 = t0 + q * r[0, 2], t1 + q * r[1, 2], t2 + q * r[2, 2]
                if a >= 0:
                    w0, w1, w2 = spin[a, 0, s], spin[a, 1, s], spin[a, 2, s]
                    e0, e1, e2 = rate[a, 0, s], rate[a, 1, s], rate[a, 2, s]
                    wp = w0 * p0 + w1 * p1 + w2 * p2
                    ww = w0 * w0 + w1 * w1 + w2 * w2
                    a0 = push[a, 0, s] + e1 * p2 - e2 * p1 + w0 * wp - p0 * ww
                    a1 = push[a, 1, s] + e2 * p0 - e0 * p2 + w1 * wp - p1 * ww
                    a2 = push[a, 2, s] + e0 * p1 - e1 * p0 + w2 * wp - p2 * ww
                else:
                    w0 = w1 = w2 = e0 = e1 = e2 = 0.0
                    a0, a1, a2 = -gravity[0], -gravity[1], -gravity[2]
                m0, m1, m2 = turn[0, s], turn[3, s], turn[6, s]
                n0, n1, n2 = turn[1, s], turn[4, s], turn[7, s]
                o0, o1, o2 = turn[2, s], turn[5, s], turn[8, s]
                u0 = m0 * w0 + m1 * w1 + m2 * w2
                u1 = n0 * w0 + n1 * w1 + n2 * w2
                u2 = o0 * w0 + o1 * w1 + o2 * w2
                f0 = m0 * e0 + m1 * e1 + m2 * e2
                f1 = n0 * e0 + n1 * e1 + n2 * e2
                f2 = o0 * e0 + o1 * e1 + o2 * e2
                g0 = m0 * a0 + m1 * a1 + m2 * a2
                g1 = n0 * a0 + n1 * a1 + n2 * a2
                g2 = o0 * a0 + o1 * a1 + o2 * a2
                v = scale * velocity[mine, begin + s]
                dv = scale * acceleration[mine, begin + s]
                if slides:
                    g0 += 2.0 * u1 * v
                    g1 -= 2.0 * u0 * v
                    g2 += dv
                else:
                    f0 += u1 * v
                    f1 -= u0 * v
                    f2 += dv
                    u2 += v
                spin[j, 0, s], spin[j, 1, s], spin[j, 2, s] = u0, u1, u2
                rate[j, 0, s], rate[j, 1, s], rate[j, 2, s] = f0, f1, f2
                push[j, 0, s], push[j, 1, s], push[j, 2, s] = g0, g1, g2
            for s in range(count):
                w0, w1, w2 = spin[j, 0, s], spin[j, 1, s], spin[j, 2, s]
                e0, e1, e2 = rate[j, 0, s], rate[j, 1, s], rate[j, 2, s]
                xx, yy, zz = w0 * w0, w1 * w1, w2 * w2
                xy, xz, yz = w0 * w1, w0 * w2, w1 * w2
                map_moment[0, s], map_moment[1, s], map_moment[2, s] = e0, xz, -xy
                map_moment[3, s], map_moment[4, s], map_moment[5, s] = e1 - xz, e0 + yz, xx - yy
                map_moment[6, s], map_moment[7, s], map_moment[8, s] = e2 + xy, zz - xx, e0 - yz
                map_moment[9, s], map_moment[10, s], map_moment[11, s] = -yz, e1, xy
                map_moment[12, s], map_moment[13, s], map_moment[14, s] = yy - zz, e2 - xy, e1 + xz
                map_moment[15, s], map_moment[16, s], map_moment[17, s] = yz, -xz, e2
                map_force[0, s], map_force[1, s], map_force[2, s] = -(yy + zz), xy + e2, xz - e1
                map_force[3, s], map_force[4, s], map_force[5, s] = xy - e2, -(xx + zz), yz + e0
                map_force[6, s], map_force[7, s], map_force[8, s] = xz + e1, yz - e0, -(xx + yy)
            first = chain_start[j]
            depth = chain_start[j + 1] - first
            above = chain_start[a] if a >= 0 else 0
            for k in range(depth - 1):
                for s in range(count):
                    q = stroke[j, begin + s]
                    p0, p1, p2 = t0 + q * r[0, 2], t1 + q * r[1, 2], t2 + q * r[2, 2]
                    x0, x1, x2 = axis[above + k, 0, s], axis[above + k, 1, s], axis[above + k, 2, s]
                    y0 = axis[above + k, 3, s] + x1 * p2 - x2 * p1
                    y1 = axis[above + k, 4, s] + x2 * p0 - x0 * p2
                    y2 = axis[above + k, 5, s] + x0 * p1 - x1 * p0
                    for column in range(3):
                        m0, m1, m2 = turn[column, s], turn[3 + column, s], turn[6 + column, s]
                        axis[first + k, column, s] = m0 * x0 + m1 * x1 + m2 * x2
                        axis[first + k, 3 + column, s] = m0 * y0 + m1 * y1 + m2 * y2
            own = first + depth - 1
            for s in range(count):
                for column in range(6):
                    axis[own, column, s] = 0.0
                axis[own, 5 if slides else 2, s] = 1.0
            for pair in range(first, first + depth):
                scale = ratio[chain[pair]]
                for k in range(6):
                    target = slot[pair, k]
                    if target >= 0:
                        for s in range(count):
                            out[target, begin + s] += scale * (
                                axis[pair, 0, s] * map_moment[3 * k, s]
                                + axis[pair, 1, s] * map_moment[3 * k + 1, s]
                                + axis[pair, 2, s] * map_moment[3 * k + 2, s]
                            )
                for k in range(3):
                    target = slot[pair, 6 + k]
                    if target >= 0:
                        # the body's push acts on the lever: e_k x push, seen from the axis, is the axis turned by push
                        b, c = (k + 1) % 3, (k + 2) % 3
                        for s in range(count):
                            out[target, begin + s] += scale * (
                                axis[pair, c, s] * push[j, b, s]
                                - axis[pair, b, s] * push[j, c, s]
                                + axis[pair, 3, s] * map_force[3 * k, s]
                                + axis[pair, 4, s] * map_force[3 * k + 1, s]
                                + axis[pair, 5, s] * map_force[3 * k + 2, s]
                            )
                target = slot[pair, 9]
                if target >= 0:
                    for s in range(count):
                        out[target, begin + s] += scale * (
                            axis[pair, 3, s] * push[j, 0, s]
                            + axis[pair, 4, s] * push[j, 1, s]
                            + axis[pair, 5, s] * push[j, 2, s]
                        )
