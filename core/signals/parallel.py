"""Filter and thin many series at once: the parallel filter as one matrix product per block of samples.

Filtering both sides of a linear equation with the same linear filter leaves the equation true; so no delay,
no edge effect and no choice of cut-off can bias it. Only the decimated samples are computed. A tile is a
stretch of motion together with its filter. Source: Gautier 1997; Khalil & Dombre (2002), ch. 12.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from ..arrays import Indices, InstantMask, Instants, JointSeries, KeptSeries, Matrix, Samples, Series
from .state import MotionState
from .zero_phase import Modes

_ROWS = 16
"""Decimated samples per block: few cost more states per sample, many more products."""
_BLOCKS = 4
"""Blocks that are made at once of series that are made in parts."""


@dataclass(frozen=True, eq=False)
class ParallelFilter:
    """Low-pass and decimate rows of samples.

    Away from its middle the kernel is a sum of a few decays. So the samples of a block bear on the instants
    of other blocks through one complex number per decay only. It is carried from block to block, forwards
    and backwards, and the work does not grow with the kernel's length.
    """

    response: Samples
    """Symmetric kernel of odd length."""
    modes: Modes
    """The decays that it consists of."""
    decimation: int
    """Keep every n-th sample."""

    @property
    def reach(self) -> int:
        """Count the samples that the kernel sees on either side."""
        return len(self.response) // 2

    def thinned(self, step: int) -> "ParallelFilter":
        """Give the filter of every so many samples: the same kernel and gain, the same instants kept."""
        small = self.response[self.reach % step :: step]
        scale = float(self.response.sum() / small.sum())
        modes = Modes(self.modes.poles**step, self.modes.weights * scale)
        return ParallelFilter(small * scale, modes, self.decimation // step)

    @property
    def _length(self) -> int:
        """Count the samples of a block."""
        return _ROWS * self.decimation

    @cached_property
    def _condensing(self) -> Matrix:
        """Give what a block's samples add to its own instants, and to the states behind and before it."""
        samples = np.arange(self._length)
        lags = np.abs(samples[:, None] - self.decimation * np.arange(_ROWS))
        within = np.where(lags > self.reach, 0.0, self.response[np.maximum(self.reach - lags, 0)])
        ahead, back = (self.modes.poles ** steps[:, None] for steps in (self._length - samples, samples))
        return np.hstack([within, ahead.real, ahead.imag, back.real, back.imag])

    @cached_property
    def _releasing(self) -> Matrix:
        """Give what the states before and behind a block add to its instants: states x instants."""
        steps = self.decimation * np.arange(_ROWS)
        ahead, back = (
            self.modes.weights[:, None] * self.modes.poles[:, None] ** lags
            for lags in (steps, self._length - steps)
        )
        return np.vstack([ahead.real, -ahead.imag, back.real, -back.imag])

    @cached_property
    def _magnitude_band(self) -> Matrix:
        """Give the share of each sample in the magnitude of consecutive instants: samples x instants."""
        span = (_ROWS - 1) * self.decimation + len(self.response)
        band = np.zeros((span, _ROWS))
        for row in range(_ROWS):
            band[row * self.decimation : row * self.decimation + len(self.response), row] = self.response
        return np.asarray(np.abs(band) / np.abs(self.response).sum())

    def apply(self, series: Series, first: int, kept: int) -> KeptSeries:
        """Give `kept` filtered instants.

        The first lies at sample `first` of the series, beyond whose ends zeros are assumed.
        """
        return self.apply_in_parts(lambda part: series[:, part], series.shape[1], first, kept, whole=True)

    def apply_in_parts(
        self, made: Callable[[slice], Series], samples: int, first: int, kept: int, *, whole: bool = False
    ) -> KeptSeries:
        """Filter series that are made part by part, so that they never fill more than the nearest memory.

        Parameters
        ----------
        made
            Gives the series from one sample to another.
        samples
            Their number; beyond them zeros are assumed.
        whole
            Whether all are made at once.
        """
        from ..numerics.decays import carry_decays  # compiled: who only admits a request loads no compiler

        before, blocks = -(-min(self.reach, max(first, 0)) // self._length), -(-kept // _ROWS)
        beyond = max(samples - first - blocks * self._length, 0)
        total = max(before + blocks + -(-min(self.reach, beyond) // self._length), 1)
        size = total if whole else _BLOCKS
        start = first - before * self._length
        parts = [
            self._condensed(
                made, samples, start + begin * self._length, start + min(begin + size, total) * self._length
            )
            for begin in range(0, total, size)
        ]
        condensed = parts[0] if len(parts) == 1 else np.concatenate(parts, axis=1)
        states = np.empty((len(condensed), total, 4 * len(self.modes.poles)))
        carry_decays(condensed, _ROWS, self.modes.poles**self._length, states)
        inner = slice(before, before + blocks)
        out = states[:, inner] @ self._releasing
        out += condensed[:, inner, :_ROWS]
        return np.asarray(out.reshape(len(out), blocks * _ROWS)[:, :kept])

    def _condensed(self, made: Callable[[slice], Series], samples: int, begin: int, end: int) -> np.ndarray:
        """Give what `_condensing` makes of some blocks: series x blocks x (instants, states)."""
        low = min(max(begin, 0), samples)
        high = max(min(end, samples), low)
        part = made(slice(low, high))
        if (low, high) != (begin, end):
            padded = np.empty((len(part), end - begin))
            padded[:, : low - begin] = padded[:, high - begin :] = 0.0
            padded[:, low - begin : high - begin] = part
            part = padded
        return np.asarray(part.reshape(len(part), -1, self._length) @ self._condensing)

    def influence(self, marks: Series, first: int, kept: int) -> KeptSeries:
        """Give the share of the kernel's absolute mass that falls on marked samples (marks are 0 or 1)."""
        out = np.empty((len(marks), kept))
        for begin in range(0, kept, _ROWS):
            rows = min(_ROWS, kept - begin)
            left = first + begin * self.decimation - self.reach
            right = left + (rows - 1) * self.decimation + len(self.response)
            inside = slice(max(left, 0), min(right, marks.shape[1]))
            weights = self._magnitude_band[inside.start - left : inside.stop - left, :rows]
            out[:, begin : begin + rows] = marks[:, inside] @ weights
        return out


@dataclass(frozen=True, eq=False)
class Tile:
    """Carry a stretch of motion at the log's rate, with the parallel filter's decimated samples inside it."""

    state: MotionState
    """Position, velocity, acceleration at the log's rate, the filter's reach included."""
    torque: JointSeries
    """Joint torque at the same instants, N m or N."""
    parallel: ParallelFilter
    first: int
    time: Instants
    """Sample at which the first decimated sample lies, and the decimated samples in s."""
    usable: InstantMask
    """Which decimated samples may be used for which joint."""
    turning: InstantMask
    """Which of these lie so near a reversal that the direction of the joint's friction is in doubt."""
    block: Indices
    """Number of the log's block that each decimated sample belongs to."""
    follows: bool
    """Whether its first decimated sample comes right after the last of the tile before, without a gap."""

    def parts(self) -> Iterator[tuple[int, slice]]:
        """Give the blocks that it has a part of, and the decimated samples of each."""
        edges = np.flatnonzero(np.diff(self.block)) + 1
        for begin, end in pairwise((0, *edges.tolist(), len(self.block))):
            yield int(self.block[begin]), slice(begin, end)

    def by_block(self) -> Iterator[tuple[int, "Tile"]]:
        """Give the blocks that it has a part of, and that part with what the filter sees beside it."""
        for number, kept in self.parts():
            at = self.first + kept.start * self.parallel.decimation
            last = self.first + (kept.stop - 1) * self.parallel.decimation
            seen = slice(max(0, at - self.parallel.reach), last + self.parallel.reach + 1)
            yield (
                number,
                replace(
                    self,
                    state=self.state.at(seen),
                    torque=self.torque[seen],
                    first=at - seen.start,
                    time=self.time[kept],
                    usable=self.usable[kept],
                    turning=self.turning[kept],
                    block=self.block[kept],
                    follows=self.follows or kept.start > 0,
                ),
            )

    def filtered(self, series: Series) -> KeptSeries:
        """Apply the parallel filter to rows of samples and keep the tile's instants."""
        return self.parallel.apply(series, self.first, len(self.time))

    def filtered_in_parts(self, made: Callable[[MotionState], Series]) -> KeptSeries:
        """Do the same to series of which each sample follows from the motion at its instant alone."""
        return self.parallel.apply_in_parts(
            lambda part: made(self.state.at(part)), len(self.torque), self.first, len(self.time)
        )
