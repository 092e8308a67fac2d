"""Estimate a finding's size in each of several logs: a robot that was changed between them has two.

A finding is one effect in all logs. A fit of all columns to one log's rows tells how large it is there, and
the scatter between the log's blocks how well that is known, whatever the noise is. Source: Cochran,
Biometrics 10(1), 1954, on comparing the estimates of several experiments.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from ...arrays import Vector
from ..causes.protocol import number_text
from ..residual.blocks import row_blocks
from ..result import Evidence
from ..search.fitter import HypothesisFitter
from ..search.hypothesis import Hypothesis
from ..thresholds.checks import BETWEEN_LOGS, BLOCK_SCATTER
from .block_equations import BlockEquations, BlockSolution


@dataclass(frozen=True)
class SizeInLog:
    """Hold the size of a finding in one log over its size in all logs, and its deviation."""

    log: str
    size: float
    deviation: float

    @property
    def is_missing(self) -> bool:
        """Tell whether the log clearly holds less than half of the finding."""
        return self.size + BETWEEN_LOGS.clearness * self.deviation < BETWEEN_LOGS.least

    @property
    def evidence(self) -> Evidence:
        """State it."""
        return Evidence(
            f"Size of the finding in log {self.log} over that in all logs, ± {number_text(self.deviation)}; "
            f"clearly below {BETWEEN_LOGS.least:g} the finding is doubtful: it acts in other logs only",
            "least size in a log",
            self.size,
        )


@dataclass(frozen=True, eq=False)
class BetweenLogs:
    """Fit the columns of a hypothesis to each log by itself."""

    fitter: HypothesisFitter
    chosen: Hypothesis

    def least_size(self, index: int) -> SizeInLog | None:
        """Give a member's size in the log that holds least of it; None of one log or a transient cause."""
        if len(self.fitter.dataset.motions) < 2 or self.chosen.members[index].cause.traits.transient:
            return None
        return min(self._sizes(index), key=lambda one: one.size, default=None)

    def sizes_in_parts(self, index: int, parts: int) -> list[tuple[float, float]]:
        """Give a member's size in successive parts of all logs, and the deviation, no less than by the model.

        Fewer than so many where the blocks do not suffice.
        """
        blocks = self.fitted_blocks
        borders = [round(len(blocks) * part / parts) for part in range(parts + 1)]
        weight = self._weight(index)
        cut = (blocks[start:stop] for start, stop in pairwise(borders))
        return [_size(part, weight, least_by_model=True) for part in cut if len(part) > 1]

    @property
    def fitted_blocks(self) -> list[BlockEquations]:
        """List the blocks of all logs that are not held out."""
        return [block for log in self._blocks for block in log if block.gram.any()]

    @cached_property
    def equations(self) -> BlockSolution:
        """Give the equations of all of them together, and of the prior, if there is one."""
        prior, values = self.chosen.fit.prior, self.chosen.fit.values
        if prior is None:
            return BlockSolution(self.fitted_blocks)
        known, first = BlockEquations.empty(len(values)), np.arange(prior.rows.shape[1])
        known.add(first, prior.rows, prior.target - prior.rows @ values[first])
        return BlockSolution(self.fitted_blocks, (known,))

    def _weight(self, index: int) -> Vector:
        """Give the weights of all values of which a member's size, over its own, is the sum."""
        own = self.chosen.columns_of(index)
        value = self.chosen.fit.values[own]
        weight = np.zeros(len(self.chosen.fit.values))
        weight[own] = np.linalg.solve(self.chosen.covariance(index), value)
        weight /= weight[own] @ value
        return weight

    def _sizes(self, index: int) -> Iterator[SizeInLog]:
        weight = self._weight(index)
        for motion, blocks in zip(self.fitter.dataset.motions, self._blocks, strict=True):
            if len(blocks) > 1:
                yield SizeInLog(motion.log.name, *_size(blocks, weight))

    @cached_property
    def _blocks(self) -> list[list[BlockEquations]]:
        """Give the normal equations of every block of every log."""
        dataset = self.fitter.dataset
        block, width = row_blocks(dataset, BLOCK_SCATTER.blocks), len(self.chosen.fit.values)
        log = {int(number): int(own) for number, own in zip(block, dataset.log, strict=True)}
        found = {number: BlockEquations.empty(width) for number in log}
        fit = self.chosen.fit
        for rows, part, left in zip(self.fitter.rows.fitted, fit.joints, fit.left, strict=True):
            columns = part.nuisance.without_nuisance(part.columns)
            of_row = block[rows.rows]
            for number in np.unique(of_row):
                own = of_row == number
                found[int(number)].add(part.acting, columns[own], left[own])
        logs = range(len(dataset.motions))
        return [[found[number] for number, own in log.items() if own == place] for place in logs]


def _size(
    blocks: Sequence[BlockEquations], weight: Vector, *, least_by_model: bool = False
) -> tuple[float, float]:
    """Give one more than a log changes along some weights, and its deviation by the scatter of blocks."""
    solution, along = BlockSolution(blocks), weight[:, None]
    deviation = float(solution.deviations(along)[0])
    least = float(solution.model_deviations(along)[0]) if least_by_model else 0.0
    return float(1.0 + weight @ solution.change), max(deviation, least)
