"""Estimate a finding's size from the torque of each joint by itself: the joints confirm it where they agree.

A cause with one number acts on several joints, in a ratio that the robot's geometry gives. Structure that no
model explains is in no such ratio. So what several joints show at the same size is no part of something else,
however much else is left. Source: Hansen, Econometrica 50(4), 1982, on tests of over-identification; Cochran,
Biometrics 10(1), 1954, on comparing several estimates of one number.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import JointVector, SquareMatrix
from ...numerics.distributions import chi2_tail
from ..regression.gls import Fit
from ..residual.blocks import row_blocks
from ..result import Evidence
from ..search.fitter import HypothesisFitter
from ..search.hypothesis import Hypothesis
from ..thresholds.checks import BETWEEN_JOINTS, BLOCK_SCATTER
from .block_equations import BlockEquations, BlockSolution

CONFIRMED = "joints that confirm it"
"""Name of the statistic."""


@dataclass(frozen=True, eq=False)
class SizeByJoint:
    """Hold the size of a finding by each joint that it acts on, over its size by all, with covariance."""

    joints: tuple[int, ...]
    """Counted from 1."""
    sizes: JointVector
    covariance: SquareMatrix
    blocks: int
    """Number of blocks that the covariance is from."""

    @property
    def deviations(self) -> JointVector:
        """Give the deviation of each."""
        return np.asarray(np.sqrt(np.diag(self.covariance)))

    @property
    def shown_by(self) -> tuple[int, ...]:
        """List the joints that show it by themselves."""
        clear = self.sizes > BETWEEN_JOINTS.clearness * self.deviations
        return tuple(joint for joint, shows in zip(self.joints, clear, strict=True) if shows)

    @property
    def agree(self) -> bool:
        """Tell whether one size explains them all."""
        apart = float(np.sum(((self.sizes - 1.0) / self.deviations) ** 2))
        return chi2_tail(apart, len(self.joints) - 1) > BETWEEN_JOINTS.level

    @property
    def is_confirmed(self) -> bool:
        """Tell whether enough joints show it, and all agree."""
        return len(self.shown_by) >= BETWEEN_JOINTS.joints and self.agree

    @property
    def evidence(self) -> Evidence:
        """State what confirms it."""
        sizes = self.sizes[np.isin(self.joints, self.shown_by)]
        least, most, shown = sizes.min(), sizes.max(), ", ".join(map(str, self.shown_by))
        return Evidence(
            f"Joints whose own torque shows the finding: joints {shown} give {least:.2g} to {most:.2g} of "
            "its size, and all agree. What else is left does not put it in doubt",
            CONFIRMED,
            float(len(self.shown_by)),
        )


def confirming(fitter: HypothesisFitter, chosen: Hypothesis, index: int) -> SizeByJoint | None:
    """Give a member's size by each joint where joints confirm it."""
    found = sizes_by_joint(fitter, chosen, index)
    return found if found is not None and found.is_confirmed else None


def sizes_by_joint(fitter: HypothesisFitter, chosen: Hypothesis, index: int) -> SizeByJoint | None:
    """Fit a member to each joint by itself, beside all other columns; None where one joint alone has it."""
    fit, own = chosen.fit, chosen.columns_of(index)
    acting = [joint for joint, part in enumerate(fit.joints) if part.of(own).any()]
    if len(acting) < 2:
        return None
    solution = BlockSolution(_blocks(fitter, fit, own, acting))
    weights = np.eye(len(solution.change))[:, -len(acting) :]
    sizes = 1.0 + solution.change[-len(acting) :]
    return SizeByJoint(
        tuple(joint + 1 for joint in acting), sizes, solution.covariance(weights), len(solution.blocks)
    )


def _blocks(fitter: HypothesisFitter, fit: Fit, own: slice, acting: Sequence[int]) -> list[BlockEquations]:
    """Give every block's equations, with a column per joint in the place of a member's own, at the end.

    Such a column is what the member explains there, so that its value is a size.
    """
    block, width = row_blocks(fitter.dataset, BLOCK_SCATTER.blocks), own.stop - own.start
    others = len(fit.values) - width
    found = [BlockEquations.empty(others + len(acting)) for _ in range(int(block.max()) + 1)]
    for joint, (rows, part) in enumerate(zip(fitter.rows.fitted, fit.joints, strict=True)):
        before, behind = part.acting < own.start, part.acting >= own.stop
        columns, at = part.columns[:, before | behind], (part.acting - width * behind)[before | behind]
        if joint in acting:
            explained = part.of(own) @ fit.values[part.acting[~(before | behind)]]
            columns = np.column_stack([columns, explained])
            at = np.append(at, others + acting.index(joint))
        columns, of_row = part.nuisance.without_nuisance(columns), block[rows.rows]
        for number in np.unique(of_row):
            chosen = of_row == number
            found[number].add(at, columns[chosen], fit.left[joint][chosen])
    return [one for one in found if one.gram.any()]
