"""Say how fast motors and links of flexible joints swing against each other."""

from dataclasses import replace
from typing import Final

import numpy as np

from ...arrays import JointSeries
from ..mechanism import Mechanism

LONGEST_ANGLE: Final = 0.06
"""Step of the simulation times the highest angular frequency of the springs. The scheme's frequency is then
too high by a 24th of its square, 1.5e-4, and a stiffness too low by twice that; of slower modes by less."""


def fastest(mechanism: Mechanism, positions: JointSeries) -> float:
    """Give the highest angular frequency of motors and links against each other over positions, rad/s."""
    springs = mechanism.springs
    if springs is None:
        return 0.0
    rotors = np.diag(mechanism.inertia)[springs.joints]
    links = links_of(mechanism).mass_matrices(positions)[:, springs.joints][:, :, springs.joints]
    root = np.sqrt(springs.stiffness)
    compliant = np.linalg.solve(links, np.broadcast_to(np.eye(len(root)), links.shape)) + np.diag(
        1.0 / rotors
    )
    return float(np.sqrt(np.linalg.eigvalsh(compliant * np.outer(root, root)).max()))


def links_of(mechanism: Mechanism) -> Mechanism:
    """Give the mechanism without the rotors of its flexible joints."""
    springs = mechanism.springs
    if springs is None:
        return mechanism
    inertia = mechanism.inertia.copy()
    inertia[springs.joints, springs.joints] = 0.0
    return replace(mechanism, inertia=inertia)
