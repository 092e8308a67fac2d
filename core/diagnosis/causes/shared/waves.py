"""Turn the two coefficients of a wave into amplitude and angle, with their deviations."""

import numpy as np

from ....arrays import SquareMatrix, Vector

Estimate = tuple[float, float]
"""Value and standard deviation."""


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
    deviations = [float(np.sqrt(max(one @ covariance @ one, 0.0))) for one in (along, across)]
    return (amplitude, deviations[0]), (float(np.arctan2(y, x)), deviations[1])
