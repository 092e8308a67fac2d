"""Compute mass matrix, torque of moving masses and springs for one state, compiled: blocks of one lane.

Placing the bodies is apart, since the torque at one position is asked for at more than one velocity.
"""

# ruff: noqa: ANN001  # numba: types stand in signatures, tables come singly
# Types stand in numba's signatures, which mypy does not read:
# mypy: disable-error-code="no-untyped-def"

import numpy as np
from numba import njit

from ..kernel import (
    gather,
    load_link,
    mass_of_block,
    move_link,
    place_axis,
    place_body,
    place_link,
    torque_of_block,
)

FIRST, ONE = np.uintp(0), np.uintp(1)


@njit(inline="always")
def lane_place(robot, scratch, kept, position) -> None:
    """Write frames, axes and bodies in the base's frame; `kept` gets the bodies, which are summed later."""
    prismatic, antecedent, joint, ratio, offset, rotation, translation, _, bodies, _ = robot
    frame, axis, _, _, _, moved = scratch
    for j in range(len(antecedent)):
        own, parent, drive = np.uintp(j + 1), np.uintp(antecedent[j]), np.uintp(joint[j])
        slides = 1.0 if prismatic[j] else 0.0
        fixed, shift = rotation[j], translation[j]
        place_link(
            frame, parent, own, moved, position, drive, FIRST, ONE, ratio[j], offset[j], slides, fixed, shift
        )
        place_axis(axis, frame, own, ratio[j] * (1.0 - slides), ratio[j] * slides, ONE)
        place_body(kept, frame, own, bodies[j], ONE)


@njit(inline="always")
def lane_torque(robot, scratch, kept, velocity, acceleration, torque) -> None:
    """Write the torque of the placed bodies' motion."""
    _, antecedent, joint, _, _, _, _, _, bodies, _ = robot
    _, axis, motion, _, wrench, moved = scratch
    torque[:] = 0.0
    for j in range(len(antecedent)):
        own, parent, drive = np.uintp(j + 1), np.uintp(antecedent[j]), np.uintp(joint[j])
        move_link(motion, parent, own, moved, axis, velocity, acceleration, drive, FIRST, ONE)
        load_link(wrench, motion, kept, own, bodies[j, 9], ONE)
    for j in range(len(antecedent) - 1, -1, -1):
        if antecedent[j] > 0:
            gather(wrench, np.uintp(antecedent[j]), np.uintp(j + 1), np.uintp(6), ONE)
    torque_of_block(joint, axis, wrench, torque, FIRST, ONE)


@njit(inline="always")
def lane_mass(robot, scratch, kept, mass, joints) -> None:
    """Write the lower triangle of the placed bodies' mass matrix."""
    _, antecedent, joint, _, _, _, _, _, _, masses = robot
    _, axis, _, body, _, moved = scratch
    mass[:] = 0.0
    body[:] = kept
    for j in range(len(antecedent) - 1, -1, -1):
        if antecedent[j] > 0:
            gather(body, np.uintp(antecedent[j]), np.uintp(j + 1), np.uintp(9), ONE)
    mass_of_block(antecedent, joint, masses, axis, body, moved, mass, joints, FIRST, ONE)


@njit(inline="always")
def lane_springs(out, stiffness, position) -> None:
    """Take the torque of springs between coordinates from what drives them; none where the table is empty."""
    for i in range(len(stiffness)):
        for j in range(len(stiffness)):
            out[i, 0] -= stiffness[i, j] * position[j, 0]
