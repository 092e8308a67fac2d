"""Scan the waves per turn of a joint, and turn a wave's two parts into amplitude, harmonic and phase.

amplitude cos(h q + phase) is linear in a cosine and a sine part. Both are taken about the middle of the range
of motion, where an error of h does not turn the phase; at q = 0 it does, by the middle's angle times it.
"""

from collections.abc import Sequence

import numpy as np

from ....arrays import Samples
from ..protocol import FittedCause, Quantity, Scalars
from .waves import amplitude_and_angle

DISTINCT = 1.6
"""Two waves whose phases drift apart by this many radians over the range are nine tenths alike."""


def harmonics(angle: Samples, *, lowest: float, highest: float, most: int) -> Sequence[Scalars]:
    """List waves per turn that a range of motion tells apart; whole ones where it tells those apart.

    Parameters
    ----------
    angle
        The joint's angle, rad.
    lowest, highest
        Bounds on the waves per turn.
    most
        Bound on how many are listed.

    Examples
    --------
    >>> [one["harmonic"] for one in harmonics(np.array([0.0, 0.8]), lowest=2.0, highest=7.0, most=9)]
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
    amplitude, with_other_holdout = amplitude_and_angle(
        flip * solved.values, solved.covariance * np.outer(flip, flip)
    )
    harmonic, centre = solved.scalars["harmonic"], solved.scalars["centre"]
    scatter = solved.deviations.get("harmonic", 0.0)
    phase = (with_other_holdout[0] - harmonic * centre + np.pi) % (2.0 * np.pi) - np.pi
    return (
        Quantity("amplitude", joint, solved.unit(unit), *amplitude),
        Quantity("harmonic", joint, "1", harmonic, scatter),
        Quantity("phase", joint, "rad", phase, float(np.hypot(with_other_holdout[1], centre * scatter))),
    )
