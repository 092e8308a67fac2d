"""Place frames by modified Denavit-Hartenberg rows, and write any placement as such a row.

Six numbers (two angles and two lengths more than the classic four) describe every pose, so that a tree, a
tilted base or a URDF can all be written as one table. Source: Khalil & Kleinfinger, A new geometric notation
for open and closed-loop robots, ICRA 1986; Khalil & Dombre (2002), ch. 3 and 7. **Khalil's d is Craig's a,
Khalil's r is Craig's d.**
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Rotation, Vector3
from .frames import rotation_x, rotation_z


@dataclass(frozen=True)
class ModifiedDHRow:
    """Describe where a frame sits on its antecedent at zero coordinate.

    T = Rot(z, gamma) Trans(z, b) Rot(x, alpha) Trans(x, d) Rot(z, theta) Trans(z, r). A revolute joint adds
    its coordinate to theta, a prismatic joint adds it to r.

    Examples
    --------
    >>> ModifiedDHRow(alpha=0.0, d=0.5, r=0.25).placement()[1]
    array([0.5 , 0.  , 0.25])
    """

    alpha: float
    d: float
    """Angle (rad) about x and distance (m) along x from the antecedent's z axis to this one."""
    r: float
    theta: float = 0.0
    """Distance (m) along z and angle (rad) about z from the common normal to this frame."""
    gamma: float = 0.0
    b: float = 0.0
    """Angle (rad) about and distance (m) along the antecedent's z axis to the common normal; zero in a plain
    chain."""

    def placement(self) -> tuple[Rotation, Vector3]:
        """Give rotation and translation (m) of the frame on its antecedent at zero coordinate."""
        normal = rotation_z(self.gamma)
        axis = normal @ rotation_x(self.alpha)
        translation = np.array([0.0, 0.0, self.b]) + self.d * normal[:, 0] + self.r * axis[:, 2]
        return axis @ rotation_z(self.theta), translation


def row_of_placement(rotation: Rotation, translation: Vector3) -> ModifiedDHRow:
    """Write a pose as a modified DH row.

    The row is unique up to the sign of the common normal while the two z axes are not parallel; where they
    are, gamma turns x towards the new origin and b is zero.

    Notes
    -----
    With x the common normal, translation = b z0 + d x + r z1; its product with x gives d, with z0 x x gives
    r, with z0 the rest. Axes within 1e-9 rad of parallel are treated as parallel: the common normal would lie
    1e9 lengths away.

    Examples
    --------
    >>> row_of_placement(np.eye(3), np.array([0.0, 0.5, 0.25]))
    ModifiedDHRow(alpha=0.0, d=0.5, r=0.25, theta=-1.5707963267948966, gamma=1.5707963267948966, b=0.0)
    """
    across = float(np.hypot(rotation[0, 2], rotation[1, 2]))
    if across < 1e-9:
        return _parallel_row(rotation, translation)
    gamma = float(np.arctan2(rotation[0, 2], -rotation[1, 2]))
    alpha = float(np.arctan2(across, rotation[2, 2]))
    theta = float(np.arctan2(rotation[2, 0], rotation[2, 1]))
    normal = rotation_z(gamma)
    r = float(-normal[:, 1] @ translation) / across
    return ModifiedDHRow(
        alpha=alpha,
        d=float(normal[:, 0] @ translation),
        r=r,
        theta=theta,
        gamma=gamma,
        b=float(translation[2]) - r * float(rotation[2, 2]),
    )


def _parallel_row(rotation: Rotation, translation: Vector3) -> ModifiedDHRow:
    upright = rotation[2, 2] > 0.0
    d = float(np.hypot(translation[0], translation[1]))
    gamma = float(np.arctan2(translation[1], translation[0])) if d > 0.0 else 0.0
    turned = rotation_z(-gamma) @ rotation
    return ModifiedDHRow(
        alpha=0.0 if upright else float(np.pi),
        d=d,
        r=float(translation[2]) if upright else -float(translation[2]),
        theta=float(np.arctan2(turned[1, 0] if upright else -turned[1, 0], turned[0, 0])),
        gamma=gamma,
    )
