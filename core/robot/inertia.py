"""Describe a rigid body by ten numbers, and test their physical consistency by one matrix.

A body is physically consistent when its 4x4 pseudo-inertia is positive definite. The 6x6 spatial inertia is a
weaker test: it accepts bodies whose principal moments break the triangle inequality. The matrix is defined
once, as ten constant basis matrices, and numpy and the solver both use that definition. Source: Wensing, Kim
& Slotine, IEEE RA-L 3(1), 2018.
"""

import numpy as np

from ..arrays import LinkParameters, PseudoInertia, Rotation, Vector3
from .frames import cross_matrix
from .model import INERTIAL_SYMBOLS


def _basis() -> np.ndarray:
    basis = np.zeros((10, 4, 4))
    basis_of = {symbol: basis[position] for position, symbol in enumerate(INERTIAL_SYMBOLS)}
    for axis, symbol in enumerate(("XX", "YY", "ZZ")):
        basis_of[symbol][:3, :3] = 0.5 * np.eye(3)
        basis_of[symbol][axis, axis] = -0.5
    for (row, column), symbol in (((0, 1), "XY"), ((0, 2), "XZ"), ((1, 2), "YZ")):
        basis_of[symbol][row, column] = basis_of[symbol][column, row] = -1.0
    for axis, symbol in enumerate(("MX", "MY", "MZ")):
        basis_of[symbol][axis, 3] = basis_of[symbol][3, axis] = 1.0
    basis_of["M"][3, 3] = 1.0
    return basis


PSEUDO_INERTIA_BASIS = _basis()
"""The pseudo-inertia is linear in the ten parameters: J = sum_k basis[k] p[k], p in Khalil's order."""
PSEUDO_INERTIA_BASIS.setflags(write=False)


def pseudo_inertia(link: LinkParameters) -> PseudoInertia:
    """Arrange a body's ten parameters as its pseudo-inertia.

    J = [[Sigma, h], [h', m]] with Sigma = trace(I)/2 E - I, I the inertia about the frame's origin in kg m2,
    h the first moments in kg m, m the mass in kg.

    Examples
    --------
    A point mass of 2 kg at x = 0.5 m has YY = ZZ = 0.5 kg m2; all its second moment lies along x.

    >>> J = pseudo_inertia(np.array([0, 0, 0, 0.5, 0, 0.5, 1.0, 0, 0, 2.0]))
    >>> float(J[0, 0]), float(J[0, 3]), float(J[3, 3])
    (0.5, 1.0, 2.0)
    """
    return np.asarray(np.tensordot(link, PSEUDO_INERTIA_BASIS, axes=1))


def link_parameters(matrix: PseudoInertia) -> LinkParameters:
    """Read the ten parameters back from a pseudo-inertia; the inverse of `pseudo_inertia`."""
    second = matrix[:3, :3]
    inertia = np.trace(second) * np.eye(3) - second
    return np.array([*inertia[0], *inertia[1, 1:], inertia[2, 2], *matrix[:3, 3], matrix[3, 3]])


def inertia_about_origin(link: LinkParameters) -> Rotation:
    """Give the 3x3 inertia about the frame's origin in kg m2."""
    xx, xy, xz, yy, yz, zz = link[:6]
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def from_mass_properties(mass: float, centre: Vector3, inertia_at_com: Rotation) -> LinkParameters:
    """Describe a body by ten parameters, given mass (kg), mass centre (m) and inertia about it (kg m2).

    Examples
    --------
    >>> from_mass_properties(2.0, np.array([0.5, 0.0, 0.0]), np.zeros((3, 3)))[5]
    np.float64(0.5)
    """
    lever = cross_matrix(centre)
    inertia = inertia_at_com - mass * lever @ lever
    return np.array([*inertia[0], *inertia[1, 1:], inertia[2, 2], *(mass * centre), mass])


def mass_properties(link: LinkParameters) -> tuple[float, Vector3, Rotation]:
    """Give mass (kg), mass centre (m) and inertia about it (kg m2); without mass the centre is the origin."""
    mass = float(link[9])
    centre = link[6:9] / mass if mass > 0.0 else np.zeros(3)
    lever = cross_matrix(centre)
    return mass, centre, inertia_about_origin(link) + mass * lever @ lever


def transform_body(link: LinkParameters, rotation: Rotation, translation: Vector3) -> LinkParameters:
    """Express a body in another frame.

    J -> T J T' with T = [[R, t], [0, 1]] the pose of the body's present frame in the new one (t in m).

    Examples
    --------
    A unit point mass at the origin, seen from a frame in which that origin lies at z = 1 m:

    >>> point = np.eye(10)[9]
    >>> transform_body(point, np.eye(3), np.array([0.0, 0.0, 1.0]))[[0, 8]]
    array([1., 1.])
    """
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = rotation, translation
    return link_parameters(pose @ pseudo_inertia(link) @ pose.T)
