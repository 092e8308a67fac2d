"""Estimate findings again with instruments: columns of a motion that holds little noise of the positions.

Where columns hold the positions' noise, least squares is biased; in a log of a controlled robot also because
the torque answers that noise. What resembles it seems to be there in every part of the log. The columns Z of
the smoothed motion follow the true ones and hold little of the noise: Z'(y - X b) = 0 is solved. An effect of
the robot is in both estimates, one of the noise in least squares alone.
Sources: Reiersol, Arkiv for Matematik 32A, 1945; Soderstrom & Stoica, Instrumental Variable Methods (1983);
Durbin 1954 and Hausman, Econometrica 46, 1978, for the difference; Liang & Zeger, Biometrika 73(1), 1986, for
the scatter between blocks.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import fdtrc

from ...arrays import EquationRows, Indices, Matrix, Vector, Weights
from ..dataset.smooth_motion import with_smooth_motion
from ..residual.blocks import row_blocks
from ..search.fitter import HypothesisFitter
from ..search.hypothesis import Hypothesis
from ..thresholds.checks import BLOCK_SCATTER

RANK_TOLERANCE = 1e-8
"""Share of the largest singular value below which the instruments do not determine a direction."""


@dataclass(frozen=True, eq=False)
class Instruments:
    """Estimate the members of a hypothesis by instrumental variables, all when one is first asked for."""

    fitter: HypothesisFitter
    whole: Hypothesis

    def log_p(self, index: int) -> float:
        """Give the log of the p-value of a member's size, by the scatter between blocks."""
        own = self._own(index)
        return _log_p(self.values[own], self._changes[:, own])

    def log_p_of_difference(self, index: int) -> float:
        """Give the log of the p-value of what least squares finds more or less of a member."""
        own = self._own(index)
        return _log_p(self.whole.fit.values[own] - self.values[own], self._changes[:, own])

    def change(self, index: int) -> float:
        """Give the share of a member's size by which instruments find more or less.

        Coefficients count in units of their scatter between blocks.
        """
        own = self._own(index)
        found = self.whole.fit.values[own]
        scale = np.sqrt(np.maximum(np.sum(self._changes[:, own] ** 2, axis=0), np.finfo(float).tiny))
        size = max(float(np.linalg.norm(found / scale)), np.finfo(float).tiny)
        return float(np.linalg.norm((self.values[own] - found) / scale) / size)

    def _own(self, index: int) -> Indices:
        """Give the places of a member's coefficients, those of columns without motion left out."""
        fit = self.whole.fit
        own = np.arange(len(fit.values))[self.whole.columns_of(index)]
        return np.asarray(own[fit.shown[own]])

    @cached_property
    def _instruments(self) -> tuple[EquationRows, ...]:
        """Give, per joint, the columns of the smoothed motion, white and without their nuisance part."""
        smooth, whole = with_smooth_motion(self.fitter.dataset), self.whole
        base = smooth.observed(self.fitter.plan)
        of_members = smooth.columns([one.term(smooth, self.fitter.operating_point) for one in whole.members])
        out = []
        for joint, part in enumerate(whole.fit.joints):
            columns = np.zeros((len(smooth.time), len(whole.fit.values)))
            columns[:, : base[joint].shape[1]] = base[joint]
            for index, own in enumerate(of_members):
                columns[:, whole.columns_of(index)] = own.get(joint, 0.0)
            rows = self.fitter.rows.fitted[joint].rows
            out.append(part.nuisance.without_nuisance(part.white(columns[np.ix_(rows, part.acting)])))
        return tuple(out)

    @cached_property
    def values(self) -> Weights:
        """Give the coefficients b of Z'(y - X b) = 0, a prior's equations included."""
        right, prior = np.zeros(len(self.whole.fit.values)), self.fitter.prior
        for instruments, part in zip(self._instruments, self.whole.fit.joints, strict=True):
            right[part.acting] += instruments.T @ part.torque
        whole = right if prior is None else right + prior.slope(np.zeros(len(right)))
        return self._solved(whole[:, None])[:, 0]

    @cached_property
    def _changes(self) -> Matrix:
        """Give how much each block's rows alone change the coefficients, blocks x coefficients."""
        fitter, fit = self.fitter, self.whole.fit
        block = row_blocks(fitter.dataset, BLOCK_SCATTER.blocks)
        sums, seen = np.zeros((int(block.max()) + 1, len(fit.values))), set[int]()
        for instruments, rows, part in zip(self._instruments, fitter.rows.fitted, fit.joints, strict=True):
            numbers, first = np.unique(block[rows.rows], return_index=True)
            if len(numbers):
                pulls = instruments * part.left(self.values)[:, None]
                sums[np.ix_(numbers, part.acting)] += np.add.reduceat(pulls, first)
                seen.update(numbers.tolist())
        return self._solved(sums[sorted(seen)].T).T

    @cached_property
    def _equations(self) -> tuple[Matrix, Vector]:
        """Give Z'X over the sizes of its rows and columns, and the sizes of the rows."""
        fit, prior = self.whole.fit, self.fitter.prior
        gram, square = np.zeros((len(fit.values), len(fit.values))), np.zeros(len(fit.values))
        for instruments, part in zip(self._instruments, fit.joints, strict=True):
            gram[np.ix_(part.acting, part.acting)] += instruments.T @ part.columns
            square[part.acting] += np.sum(instruments**2, axis=0)
        if prior is not None:
            known = prior.rows.shape[1]
            gram[:known, :known] += prior.rows.T @ prior.rows
        sizes = np.sqrt(np.where(square > 0.0, square, 1.0))
        return gram / np.outer(sizes, fit.scale), sizes

    def _solved(self, right: Matrix) -> Matrix:
        """Solve Z'X b = right; directions that the instruments do not determine stay at zero."""
        scaled, sizes = self._equations
        solved, *_ = np.linalg.lstsq(scaled, right / sizes[:, None], rcond=RANK_TOLERANCE)
        return np.asarray(solved / self.whole.fit.scale[:, None])


def _log_p(values: Vector, changes: Matrix) -> float:
    """Give the log of Hotelling's p-value of some coefficients that blocks change by so much."""
    blocks, width = changes.shape
    if blocks <= width:
        return 0.0
    tiny = np.finfo(float).tiny
    scale = np.sqrt(np.maximum(np.sum(changes**2, axis=0), tiny))
    spread = blocks / (blocks - 1) * (changes / scale).T @ (changes / scale)
    along, *_ = np.linalg.lstsq(spread, values / scale, rcond=RANK_TOLERANCE)
    statistic = float(values / scale @ along) * (blocks - width) / (blocks - 1)
    return float(np.log(max(fdtrc(width, blocks - width, max(statistic / width, 0.0)), tiny)))
