"""Find joints whose motion is too quick for the rate at which it was sampled.

Derivatives by differences need about ten samples per period of the motion. The velocity's spectrum, averaged
over windows of the log, says up to which frequency the motion reaches.
"""

import numpy as np

from ...arrays import Samples, Series
from ..model import Defect
from .stretch import Facts, Stretch

LONGEST_WINDOW = 4096
SHORTEST_WINDOW = 32
WINDOWS_PER_STRETCH = 2
POWER_SHARE = 0.95
FEWEST_SAMPLES_PER_PERIOD = 10.0
UNEVEN = 0.01
"""Steps that differ by less than this share of their median count as even."""
SMALLEST_INCREMENT = 0.01
"""Root mean square increment as a share of the range: below this, quick motion is noise and not motion."""


class Bandwidth:
    """Average the spectrum of the position increments."""

    def __init__(self, joints: int) -> None:
        self._window = 0
        self._power: Series = np.zeros((joints, 0))
        self._squares = np.zeros(joints)
        self._increments = 0

    def update(self, stretch: Stretch) -> None:
        """Take the next stretch into account."""
        increments = np.diff(_on_even_clock(stretch), axis=1)
        if not self._window:
            self._window = 1 << int(np.log2(min(increments.shape[1], LONGEST_WINDOW)))
            self._power = np.zeros((len(increments), self._window // 2 + 1))
        windows = min(increments.shape[1] // self._window, WINDOWS_PER_STRETCH)
        for index in range(windows):
            part = increments[:, index * self._window : (index + 1) * self._window]
            spectrum = np.fft.rfft(part * np.hanning(self._window), axis=1)
            self._power += spectrum.real**2 + spectrum.imag**2
            self._squares += np.einsum("ij,ij->i", part, part)
            self._increments += self._window

    def edges(self, facts: Facts) -> dict[int, float]:
        """Give the frequency (Hz) below which the velocity's power lies, of every joint that moves."""
        if self._window < SHORTEST_WINDOW or not self._increments:
            return {}
        quick = np.sqrt(self._squares / self._increments) > SMALLEST_INCREMENT * facts.span("position")
        return {joint: edge for joint, edge in self._of_moving(facts).items() if quick[joint]}

    def highest(self, facts: Facts) -> float:
        """Give the highest of these frequencies (Hz), of slow joints as well; 0 where none is known.

        What a slow joint's noise adds makes it higher, never lower.
        """
        if self._window < SHORTEST_WINDOW or not self._increments:
            return 0.0
        return max(self._of_moving(facts).values(), default=0.0)

    def _of_moving(self, facts: Facts) -> dict[int, float]:
        frequencies = np.fft.rfftfreq(self._window, facts.step)
        moving = np.flatnonzero(self._power.sum(axis=1) > 0.0)
        return {joint: self._edge(joint, frequencies) for joint in map(int, moving) if facts.travels(joint)}

    def _edge(self, joint: int, frequencies: Samples) -> float:
        share = np.cumsum(self._power[joint]) / self._power[joint].sum()
        return float(frequencies[int(np.searchsorted(share, POWER_SHARE))])

    def defects(self, facts: Facts) -> list[Defect]:
        """State the joints whose motion is sampled too slowly."""
        found = []
        for joint, edge in self.edges(facts).items():
            if edge * facts.step * FEWEST_SAMPLES_PER_PERIOD > 1.0:
                statement = (
                    f"{100.0 * POWER_SHARE:g} % of the power of joint {joint + 1}'s velocity lies below "
                    f"{edge:.3g} Hz, which a rate of {1.0 / facts.step:.4g} Hz samples only "
                    f"{1.0 / (edge * facts.step):.2g} times per period; derivatives need some "
                    f"{FEWEST_SAMPLES_PER_PERIOD:g}."
                )
                found.append(Defect("slow_rate", "position", joint + 1, facts.samples, (), statement))
        return found


def _on_even_clock(stretch: Stretch) -> Series:
    """Interpolate the new positions on an even clock: an uneven one modulates what is a steady motion."""
    time, position = stretch.time[stretch.first_new :], stretch.position[:, stretch.first_new :]
    steps = np.diff(time)
    step = float(np.median(steps))
    if np.ptp(steps) <= UNEVEN * step:
        return position
    whole = min(len(time), int((time[-1] - time[0]) / step) + 1)
    grid = time[0] + step * np.arange(whole)
    return np.array([np.interp(grid, time, values) for values in position])
