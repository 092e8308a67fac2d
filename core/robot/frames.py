"""Turn and shift frames: the few rotations that robot descriptions are written in.

Conventions: matrices map coordinates of the moved frame into the reference frame, angles in rad, lengths in
m. Source: Khalil & Dombre (2002), ch. 2; URDF's roll-pitch-yaw is about fixed axes x, y, z in that order.
"""

import numpy as np

from ..arrays import Rotation, Vector3


def rotation_x(angle: float) -> Rotation:
    """Rotate about x by an angle in rad."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def rotation_y(angle: float) -> Rotation:
    """Rotate about y by an angle in rad."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def rotation_z(angle: float) -> Rotation:
    """Rotate about z by an angle in rad."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def rotation_rpy(roll: float, pitch: float, yaw: float) -> Rotation:
    """Rotate by roll, pitch and yaw about the fixed axes x, y, z, in rad."""
    return np.asarray(rotation_z(yaw) @ rotation_y(pitch) @ rotation_x(roll))


def rpy_of_rotation(rotation: Rotation) -> Vector3:
    """Give roll, pitch and yaw about the fixed axes x, y, z, in rad; the inverse of `rotation_rpy`.

    Notes
    -----
    Where x points up or down, yaw and roll are one angle and any share of it may go to yaw. Pitch and roll
    are read off what the chosen yaw leaves, so that all digits of the rotation come back there too.

    Examples
    --------
    >>> rpy_of_rotation(rotation_y(np.pi / 2))[1] == np.pi / 2
    np.True_
    """
    yaw = np.arctan2(rotation[1, 0], rotation[0, 0])
    rest = rotation_z(-yaw) @ rotation
    pitch = np.arctan2(-rest[2, 0], rest[0, 0])
    roll = np.arctan2(-rest[1, 2], rest[1, 1])
    return np.array([roll, pitch, yaw])


def rotation_to(axis: Vector3) -> Rotation:
    """Give a rotation whose third column is the given unit axis.

    The rotation is the identity for z itself and turns by the smallest angle otherwise, so that frames whose
    joint axis already is z keep their name and meaning.

    Examples
    --------
    >>> rotation_to(np.array([0.0, 1.0, 0.0])) @ np.array([0.0, 0.0, 1.0])
    array([0., 1., 0.])
    """
    x, y, z = (float(value) for value in axis)
    across = x * x + y * y
    if z < 0.0 and across < 1e-30:  # nearer to -z than rounding can tell
        return np.diag([1.0, -1.0, -1.0])
    # Both forms are equal; near -z only the second keeps its digits.
    scale = 1.0 / (1.0 + z) if z >= 0.0 else (1.0 - z) / across
    return np.array(
        [[1.0 - x * x * scale, -x * y * scale, x], [-x * y * scale, 1.0 - y * y * scale, y], [-x, -y, z]]
    )


def nearest_rotation(matrix: Rotation) -> Rotation:
    """Give the rotation nearest to a matrix that rounding has left almost one.

    Notes
    -----
    The orthogonal factor of the polar decomposition has the least distance. Source: Higham, SIAM J. Sci.
    Stat. Comput. 7(4), 1986.

    Examples
    --------
    >>> nearest_rotation(np.diag([1.0, 0.999, 1.001]))
    array([[1., 0., 0.],
           [0., 1., 0.],
           [0., 0., 1.]])
    """
    left, _, right = np.linalg.svd(matrix)
    return np.asarray(left @ right)


def cross_matrix(vector: Vector3) -> Rotation:
    """Write the cross product with a vector as a matrix: ``cross_matrix(a) @ b == a x b``."""
    x, y, z = vector
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
