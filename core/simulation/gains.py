"""Hold the gains of joint controllers, and choose soft ones for a robot."""

from dataclasses import dataclass

import numpy as np

from ..arrays import JointSeries, JointVector
from .mechanism import Mechanism


@dataclass(frozen=True, eq=False)
class Gains:
    """Hold proportional and derivative gains per joint, N m/rad and N m s/rad (N/m, N s/m)."""

    stiffness: JointVector
    damping: JointVector


def default_gains(mechanism: Mechanism, position: JointSeries, bandwidth_hz: float) -> Gains:
    """Damp every joint critically at a bandwidth, for the median inertia it sees on its way."""
    inertia = np.median(np.diagonal(mechanism.mass_matrices(position), axis1=1, axis2=2), axis=0)
    rate = 2.0 * np.pi * bandwidth_hz
    return Gains(inertia * rate**2, 2.0 * inertia * rate)
