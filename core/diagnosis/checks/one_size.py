"""Test whether one number of the whole robot is the same on all joints, and all along the logs.

A delay of all torques is one number. Channels that are read one after the other have another delay each, and
two clocks that drift apart have one that grows. A fit of one number gives some mean of these, however clear
it is. So a finding is doubtful where sizes by the joints, or by the parts of the logs, differ by more than
their covariance and the errors of other effects explain. Whatever it stands for, its remainder may resemble
other causes: what explains less is doubtful, too.
Sources: Cochran, Biometrics 10(1), 1954; Hotelling, Ann. Math. Stat. 2(3), 1931.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import fdtrc

from ...arrays import Matrix, SquareMatrix, Vector
from ..causes.protocol import number_text
from ..result import Evidence, Finding
from ..search.fitter import HypothesisFitter
from ..search.hypothesis import Hypothesis
from ..thresholds.checks import ONE_SIZE
from .between_joints import sizes_by_joint
from .between_logs import BetweenLogs

SEVERAL = "p-value of one size"
"""Name of the statistic, which only a finding of several sizes has."""


@dataclass(frozen=True, eq=False)
class Sizes:
    """Hold a finding's sizes over its size in all, with their covariance, and what they are by."""

    by: str
    names: Sequence[str]
    sizes: Vector
    covariance: SquareMatrix
    blocks: int
    """Number of blocks that the covariance is from."""
    contrasts: Matrix
    """Sums of the sizes that are zero where all are one, in rows."""

    @property
    def p_value(self) -> float:
        """Give the probability of sizes so different if all are one, but for a share."""
        apart = self.contrasts @ self.sizes
        allowed = self.covariance + ONE_SIZE.apart**2 * np.eye(len(self.sizes))
        statistic = float(apart @ np.linalg.solve(self.contrasts @ allowed @ self.contrasts.T, apart))
        left = max(self.blocks - len(self.sizes), 1)
        return float(fdtrc(len(apart), left, statistic / len(apart)))

    @property
    def evidence(self) -> Evidence:
        """State how they differ."""
        deviations = np.sqrt(np.diag(self.covariance))
        each = ", ".join(
            f"{name} {number_text(size, 2)} ± {number_text(deviation)}"
            for name, size, deviation in zip(self.names, self.sizes, deviations, strict=True)
        )
        return Evidence(
            f"Probability that {self.by} have one size, within {100.0 * ONE_SIZE.apart:.0f} %; below "
            f"{ONE_SIZE.level:g} the finding is doubtful. Over its size in all they give: {each}",
            SEVERAL,
            self.p_value,
        )


def several_sizes(
    fitter: HypothesisFitter, chosen: Hypothesis, index: int, logs: BetweenLogs
) -> tuple[Evidence, ...]:
    """State that a finding of one number for the whole robot has several sizes; nothing where it has not.

    Beside a reference, which holds the values, no part of the rows tells its own size.
    """
    if chosen.members[index].site or chosen.members[index].cause.traits.transient or fitter.prior is not None:
        return ()
    found = (_by_joint(fitter, chosen, index), _by_part(logs, index))
    return tuple(one.evidence for one in found if one is not None and one.p_value < ONE_SIZE.level)


def has_several_sizes(finding: Finding) -> bool:
    """Tell whether a finding was stated to have several sizes."""
    return any(one.statistic == SEVERAL for one in finding.evidence)


def _by_joint(fitter: HypothesisFitter, chosen: Hypothesis, index: int) -> Sizes | None:
    found = sizes_by_joint(fitter, chosen, index)
    if found is None:
        return None
    return Sizes(
        "the joints, each by its own torque,",
        [f"joint {joint}" for joint in found.joints],
        found.sizes,
        found.covariance,
        found.blocks,
        np.diff(np.eye(len(found.sizes)), axis=0),
    )


def _by_part(logs: BetweenLogs, index: int) -> Sizes | None:
    found = logs.sizes_in_parts(index, ONE_SIZE.parts)
    if len(found) < ONE_SIZE.parts:
        return None
    sizes, deviations = np.array(found).T
    names = [f"part {number}" for number in range(1, len(found) + 1)]
    covariance, blocks = np.diag(deviations**2), len(logs.fitted_blocks)
    trend = np.arange(len(sizes)) - 0.5 * (len(sizes) - 1)
    return Sizes(
        "successive parts of the logs, by their trend,", names, sizes, covariance, blocks, trend[None]
    )
