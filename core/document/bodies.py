"""Describe the bodies of links for a drawing: each as the ellipsoid that equals it.

A body's ten parameters say where its mass is and how it spreads, not what it looks like. The solid ellipsoid
of even density with the same mass, mass centre and inertia is the picture that adds nothing: its half axes
are sqrt(5 s), with s the eigenvalues of the second moments of mass about the mass centre, per mass. Where one
of them is negative, no such body exists and there is nothing to draw. Source: Traversaro et al., IROS 2016.
"""

import numpy as np

from ..arrays import LinkParameters, Parameters
from ..dynamics.model import DynamicModel
from ..dynamics.terms.rigid_body import RigidBody
from ..robot.inertia import mass_properties


def body_rows(model: DynamicModel, standard: Parameters) -> list[dict[str, object]]:
    """List a model's bodies with numbers, each in its link's frame; none where links are not modelled."""
    tables = [values for term, values in model.split(standard) if isinstance(term, RigidBody)]
    return [
        _body(number, link) for table in tables for number, link in enumerate(table.reshape(-1, 10), start=1)
    ]


def _body(number: int, link: LinkParameters) -> dict[str, object]:
    mass, centre, _ = mass_properties(link)
    half_axes, axes = solid_ellipsoid(link)
    return {"link": number, "mass": mass, "mass_centre": centre, "half_axes": half_axes, "axes": axes}


def solid_ellipsoid(link: LinkParameters) -> tuple[np.ndarray | None, np.ndarray | None]:
    """Give the half axes (m, ascending) of a body's ellipsoid and their directions as columns of a rotation.

    None, None where no such body is physically consistent.

    Examples
    --------
    A ball of 2 kg and radius 0.1 m has 0.4 m r^2 = 0.008 kg m2 about any axis through its middle.

    >>> solid_ellipsoid(np.array([0.008, 0, 0, 0.008, 0, 0.008, 0, 0, 0, 2.0]))[0].round(12)
    array([0.1, 0.1, 0.1])
    """
    mass, _, inertia = mass_properties(link)
    if mass <= 0.0:
        return None, None
    spread = 0.5 * np.trace(inertia) * np.eye(3) - inertia
    values, axes = np.linalg.eigh(spread / mass)
    if values[0] < -1e-9 * abs(values[-1]):
        return None, None
    if np.linalg.det(axes) < 0.0:
        axes[:, 0] = -axes[:, 0]
    return np.sqrt(5.0 * np.maximum(values, 0.0)), axes
