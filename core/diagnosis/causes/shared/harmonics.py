"""Scan the harmonics of a joint's angle, and convert a wave's two coefficients into amplitude and phase.

amplitude cos(h q + phase) is linear in a cosine and a sine part. Both are taken about the middle of the range
of motion, where an error of h does not change the phase; at q = 0 it does, by the middle's angle times it.
"""

from collections.abc import Sequence

import numpy as np

from ....arrays import Samples, SquareMatrix, Vector
from ..protocol import FittedCause, Quantity, Scalars

Estimate = tuple[float, float]
"""Value and standard deviation."""
DISTINCT = 1.6
"""Two waves whose phases differ by this many radians over the range have a correlation of 0.9."""


def harmonics(angle: Samples, *, lowest: float, highest: float, most: int) -> Sequence[Scalars]:
    """List the cycles per revolution that a range of motion separates; integers where it separates those.

    Parameters
    ----------
    angle
        The joint's angle, rad.
    lowest, highest
        Bounds on the cycles per revolution.
    most
        Bound on their number.

    Examples
    --------
    >>> [point["harmonic"] for point in harmonics(np.array([0.0, 0.8]), lowest=2.0, highest=7.0, most=9)]
    [2.0, 4.0, 6.0]
    """
    low, high = float(angle.min()), float(angle.max())
    step = max(1.0, DISTINCT / max(high - low, 1e-6))
    count = int(np.clip((highest - lowest) / step + 1.0, 1.0, most))
    centre = 0.5 * (low + high)
    return [{"harmonic": lowest + step * number, "centre": centre} for number in range(count)]


def wave_quantities(solved: FittedCause, unit: str) -> tuple[Quantity, ...]:
    """Give amplitude, harmonic and phase of a wave of the given unit."""
    joint, flip = solved.site[0], np.array([1.0, -1.0])
    amplitude, angle = amplitude_and_angle(flip * solved.values, solved.covariance * np.outer(flip, flip))
    harmonic, centre = solved.scalars["harmonic"], solved.scalars["centre"]
    scatter = solved.deviations.get("harmonic", 0.0)
    phase = (angle[0] - harmonic * centre + np.pi) % (2.0 * np.pi) - np.pi
    return (
        Quantity("amplitude", joint, solved.unit(unit), *amplitude),
        Quantity("harmonic", joint, "1", harmonic, scatter),
        Quantity("phase", joint, "rad", phase, float(np.hypot(angle[1], centre * scatter))),
    )


def amplitude_and_angle(values: Vector, covariance: SquareMatrix) -> tuple[Estimate, Estimate]:
    """Write (x, y) as amplitude and angle (rad), x = a cos(angle), y = a sin(angle), by the delta method.

    Examples
    --------
    >>> amplitude_and_angle(np.array([3.0, 4.0]), 0.25 * np.eye(2))
    ((5.0, 0.5), (0.9272952180016122, 0.1))
    """
    x, y = (float(value) for value in values)
    amplitude = float(np.hypot(x, y))
    along = np.array([x, y]) / max(amplitude, 1e-300)
    across = np.array([-y, x]) / max(amplitude, 1e-300) ** 2
    deviations = [float(np.sqrt(max(slope @ covariance @ slope, 0.0))) for slope in (along, across)]
    return (amplitude, deviations[0]), (float(np.arctan2(y, x)), deviations[1])
