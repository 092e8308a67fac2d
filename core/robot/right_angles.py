"""Take right angles that were written with a few decimals (1.5708) for right angles.

As written, such an angle gives a robot base parameters whose torque differs from that of others by a few
millionths. A calibrated angle has all its digits: it is left as it is, however near a right angle it lies.
The angle itself is replaced, so that a rotation stays a rotation.
"""

import numpy as np

from ..arrays import Rotation
from .frames import nearest_rotation, rotation_rpy, rpy_of_rotation

FEWEST_DECIMALS, MOST_DECIMALS = 4, 12
"""With how many decimals a right angle is written. With fewer (1.57) it is off by a milliradian, which a log
can show; beyond twelve it is one to the last digit that rank can tell."""
_SAME = 1e-13
"""Two angles (rad) this close are one number: what an arc tangent rounds off."""
SAID_FROM = 1e-7
"""A difference (rad) below it changes no digit that a table shows and is not worth a sentence."""
_ROUNDED = 1e-12
"""A matrix whose rows are orthonormal to this is a rotation to the last digit."""


def meant_angle(angle: float) -> float:
    """Give the right angle that an angle (rad) was written for with 4 to 12 decimals, rounded or cut off.

    Examples
    --------
    >>> meant_angle(1.5708) == np.pi / 2, meant_angle(-3.14159) == -np.pi
    (True, True)
    >>> meant_angle(1.57), meant_angle(1.5707812345), meant_angle(0.0)
    (1.57, 1.5707812345, 0.0)
    """
    right = nearest_right_angle(angle)
    for decimals in range(FEWEST_DECIMALS, MOST_DECIMALS + 1):
        written = abs(angle - round(angle, decimals)) < _SAME
        if right and written and abs(angle - right) < 10.0**-decimals:
            return right
    return angle


def nearest_right_angle(angle: float) -> float:
    """Give the multiple of a right angle (rad) nearest to an angle."""
    return float(np.pi / 2 * round(angle / (np.pi / 2)))


def meant_rotation(matrix: Rotation) -> Rotation:
    """Give the rotation that a matrix of written numbers stands for.

    A matrix with few digits is first brought to the nearest rotation, then its roll, pitch and yaw are read.

    Examples
    --------
    >>> from veritorque.core.robot.frames import rotation_x
    >>> bool(np.array_equal(meant_rotation(rotation_x(1.5708)), rotation_x(np.pi / 2)))
    True
    """
    exact = np.abs(matrix @ matrix.T - np.eye(3)).max() < _ROUNDED
    rotation = matrix if exact else nearest_rotation(matrix)
    angles = [float(angle) for angle in rpy_of_rotation(rotation)]
    meant = [meant_angle(angle) for angle in angles]
    changed = max(abs(own - other) for own, other in zip(angles, meant, strict=True))
    return rotation_rpy(*meant) if changed > _SAME else rotation
