"""Turn the cosine and sine parts of a wave along an angle into amplitude and phase, with their deviations.

amplitude cos(h q + phase) is linear in two parts; by writing them about the middle of the angle's range, the
number of waves h hardly disturbs them. Source: first-order propagation of variance (delta method).
"""

from collections.abc import Sequence

import numpy as np

from core.arrays import Samples
from core.diagnosis.cause import Quantity, Scalars, Solved

DISTINCT = 1.6
"""Two waves whose phases drift apart by this many radians over the range are nine tenths alike."""


def harmonics(angle: Samples, *, lowest: float, highest: float, most: int) -> Sequence[Scalars]:
    """List the waves per turn that a range of motion tells apart; whole ones where it tells those apart.

    Parameters
    ----------
    angle
        The joint's angle, rad.
    lowest, highest
        Bounds on the waves per turn.
    most
        Bound on their number.
    """
    low, high = float(angle.min()), float(angle.max())
    step = max(1.0, DISTINCT / max(high - low, 1e-6))
    count = int(np.clip((highest - lowest) // step + 1, 1, most))
    return [
        {"harmonic": lowest + step * number, "centre": 0.5 * (low + high)} for number in range(count)
    ]


def wave_quantities(solved: Solved, unit: str) -> tuple[Quantity, ...]:
    """Give amplitude, harmonic and phase of values * (cos, sin)(harmonic (q - centre))."""
    (cosine, sine), covariance = solved.values, solved.covariance
    joint = solved.site[0]
    amplitude = float(np.hypot(cosine, sine))
    along = np.array([cosine, sine]) / amplitude
    across = np.array([sine, -cosine]) / amplitude**2
    harmonic, centre = solved.scalars["harmonic"], solved.scalars["centre"]
    scatter = solved.deviations.get("harmonic", 0.0)
    phase = float(np.arctan2(-sine, cosine)) - harmonic * centre
    deviation = float(np.hypot(np.sqrt(across @ covariance @ across), centre * scatter))
    return (
        Quantity("amplitude", joint, unit, amplitude, float(np.sqrt(along @ covariance @ along))),
        Quantity("harmonic", joint, "1", harmonic, scatter),
        Quantity("phase", joint, "rad", (phase + np.pi) % (2.0 * np.pi) - np.pi, deviation),
    )
