"""Give the frequency response of a joint from torque to position, measured and of a model.

The measured one is the ratio of cross to power density (Welch): in closed loop it is biased where noise makes
the torque, which a low coherence shows. Source: Bendat & Piersol 2010, Random Data, ch. 6.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.signal import coherence, csd, welch

from ..arrays import Spectrum, Vector
from .orders import TIME_UNIT
from .record import JointRecord
from .task import Model

LONGEST: Final = 8192
"""Rows of a transform: a resolution of 0.12 Hz at 1 kHz, where the log is long enough."""
AVERAGED: Final = 4
"""Transforms that are averaged at least."""
POINTS: Final = 300
"""Frequencies that are kept, evenly on a logarithmic scale."""


@dataclass(frozen=True, eq=False)
class Response:
    """Hold a measured frequency response."""

    frequency: Vector
    """Hz."""
    response: Spectrum
    """Rad/(N m) or m/N."""
    coherence: Vector
    """Share of the position's power that the torque explains."""


def measured_response(record: JointRecord) -> Response:
    """Give the ratio of position and torque over frequency."""
    rate, size = 1.0 / record.step, min(LONGEST, 2 * len(record.torque) // (AVERAGED + 1))
    torque, position = record.torque, record.position
    frequency, cross = csd(torque, position, rate, nperseg=size, detrend="constant")
    _, power = welch(torque, rate, nperseg=size, detrend="constant")
    _, shared = coherence(torque, position, rate, nperseg=size, detrend="constant")
    wanted = np.geomspace(frequency[2], frequency[-1], POINTS)
    kept = np.unique(np.searchsorted(frequency, wanted).clip(2, len(frequency) - 2))
    return Response(frequency[kept], cross[kept] / power[kept], shared[kept])


def model_response(model: Model, frequency: Vector) -> Spectrum:
    """Give B / A at frequencies in Hz."""
    at = 2j * np.pi * frequency * TIME_UNIT
    order, coefficients = model.order, model.coefficients
    ratio = np.polyval(order.numerator(coefficients), at) / np.polyval(order.denominator(coefficients), at)
    return np.asarray(ratio)
