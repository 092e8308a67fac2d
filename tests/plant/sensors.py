"""Read the plant's sensors: torque with noise of five kinds, encoders with a fine step, rows as a log.

Every kind of noise has a known spectrum, from which the oracle's limit is computed. Source: Kay, Fundamentals
of Statistical Signal Processing I (1993), ch. 7, for the autoregressive spectra.
"""

import numpy as np
from scipy import signal

from tests.plant.effects.effect import Signals
from veritorque.core.log.model import JointLog
from veritorque.core.log.reader import log_from_arrays

NOISES = ("white", "ar1", "strong_ar1", "heavy", "hum")
"""White; autoregressive with 0.8 and 0.98 per sample; Student's t with 3 degrees; 50 Hz with its third."""

CORRELATION = {"ar1": 0.8, "strong_ar1": 0.98}
HUM_SHARE = 0.6
"""Share of the variance that mains hum has, the third harmonic with a third of the first one's amplitude."""


def noise(kind: str, shape: tuple[int, int], rate_hz: float, rng: np.random.Generator) -> np.ndarray:
    """Draw noise of unit RMS, samples x joints."""
    if kind == "heavy":
        return rng.standard_t(3.0, shape) / np.sqrt(3.0)
    white = rng.normal(size=shape)
    if kind == "hum":
        time = np.arange(shape[0])[:, None] / rate_hz
        first, third = rng.uniform(-np.pi, np.pi, (2, shape[1]))
        wave = np.sin(2.0 * np.pi * 50.0 * time + first) + np.sin(2.0 * np.pi * 150.0 * time + third) / 3.0
        return np.sqrt(1.0 - HUM_SHARE) * white + np.sqrt(1.8 * HUM_SHARE) * wave
    if kind in CORRELATION:
        correlation = CORRELATION[kind]
        white[1:] *= np.sqrt(1.0 - correlation**2)
        return np.asarray(signal.lfilter([1.0], [1.0, -correlation], white, axis=0))
    return white


def spectrum(kind: str, frequency: np.ndarray, rate_hz: float) -> np.ndarray:
    """Give the variance per frequency of unit-RMS noise, 1 for white; mains hum's lines are left out."""
    if kind in CORRELATION:
        correlation = CORRELATION[kind]
        turn = np.exp(-2j * np.pi * frequency / rate_hz)
        return (1.0 - correlation**2) / np.abs(1.0 - correlation * turn) ** 2
    return np.full_like(frequency, 1.0 - HUM_SHARE if kind == "hum" else 1.0)


def record(signals: Signals, noise_rms: np.ndarray, kind: str, rng: np.random.Generator) -> JointLog:
    """Make the log: torque with noise, angles in encoder counts."""
    rate_hz = 1.0 / (signals.time[1] - signals.time[0])
    torque = signals.torque + noise_rms * noise(kind, signals.torque.shape, rate_hz, rng)
    for joint in signals.silent:
        torque[signals.torque[:, joint] == 0.0, joint] = 0.0
    channels = {} if signals.temperature is None else {"temperature": signals.temperature}
    return log_from_arrays("plant", signals.time, counted(signals), torque[signals.kept], **channels)


def counted(signals: Signals) -> np.ndarray:
    """Give the angles in whole encoder counts, rad, with rows that repeat."""
    return (signals.encoder_step * np.round(signals.position / signals.encoder_step))[signals.kept]
