"""Test what is left beside a finding for smooth functions of the motion, which noise does not follow.

A name is as good as the model that it completes. Where a joint's residual still follows the motion by much
beside what a finding explains there, the finding may stand for a part of something else. What is left is
compared with Gaussian processes: smooth functions of all joints' angles, of their speeds, of time, and of
the load's rate. A coefficient per function, all of one normal distribution, is a linear Gaussian process; its
variance of largest likelihood gives a likelihood ratio, which counts in the units of the finding's own. Many
functions that explain little each are seen together, and cost no more than one parameter.
Sources: Lin, Biometrika 84(2), 1997, on tests of a variance component; Rasmussen & Williams, Gaussian
Processes for Machine Learning (2006), ch. 2 and 5; Kennedy & O'Hagan, J. R. Stat. Soc. B 63, 2001, on a
discrepancy as a Gaussian process; Ramsey, J. R. Stat. Soc. B 31(2), 1969, on tests of a specification.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from ...arrays import JointVector, Matrix, SquareMatrix, Vector, Weights
from ...dynamics.prediction import Prediction
from ..dataset.dataset import Dataset
from ..regression.rows import JointRows, append_columns
from ..result import Evidence, Finding
from ..search.fitter import HypothesisFitter
from ..search.hypothesis import Candidate, Hypothesis
from ..search.likelihood_ratio import likelihood_ratio_by_joint, log_p_of
from ..search.lr_bound import ratio_without_effect
from ..thresholds.checks import STRUCTURE_LEFT
from .between_joints import CONFIRMED, SizeByJoint, confirming

VARIANCES = np.geomspace(1e-4, 1e4, 40)
"""Variances of the coefficients that are tried, over that at which functions weigh as much as noise."""
STEEP = 4.0
"""Slope of a direction of motion at standstill, over a joint's RMS speed."""
SHARE, LOG_P = "structure left", "log10 p beside structure"
"""Names of the statistics."""


@dataclass(frozen=True)
class Structure:
    """Hold the likelihood ratio statistic of the functions that explain most of what is left on a joint."""

    statistic: float
    of: str


@dataclass(frozen=True, eq=False)
class StructureLeft:
    """Test what a hypothesis leaves, each joint when it is first asked for."""

    fitter: HypothesisFitter
    whole: Hypothesis
    _known: dict[int, Structure] = field(default_factory=dict)

    def on(self, joint: int) -> Structure:
        """Give the structure that is left on a joint, counted from 0."""
        if joint not in self._known:
            self._known[joint] = self._tested(joint)
        return self._known[joint]

    def _tested(self, joint: int) -> Structure:
        dataset, point = self.fitter.dataset, self.fitter.operating_point
        functions = smooth_functions(dataset, point, joint)
        rows, names = self._rows[joint].rows, list(functions)
        if not len(rows):
            return Structure(0.0, names[0])
        columns = np.hstack([own[rows] for own in functions.values()])
        gram, slope = self._products(joint, columns)
        borders = np.cumsum([0, *(own.shape[1] for own in functions.values())])
        kinds = [slice(*ends) for ends in pairwise(borders)]
        processes = [likeliest_process(gram[kind, kind], slope[kind]) for kind in kinds]
        best = max(range(len(names)), key=lambda index: processes[index].statistic)
        found, effect = processes[best], {joint: columns[:, kinds[best]] @ processes[best].mean}
        again = ratio_without_effect(self._rows, self.whole.fit, effect) - found.penalty
        return Structure(max(found.statistic, again), names[best])

    def of_inexact_columns(self, joint: int) -> float:
        """Give the statistic of what the error of first-order columns may leave on a joint."""
        part = self.whole.fit.joints[joint]
        return sum(
            error**2 * float(np.sum((part.torque - part.left(beside)) ** 2)) for error, beside in self._beside
        )

    @cached_property
    def _beside(self) -> list[tuple[float, Weights]]:
        """Give, per member, the error of its columns, and coefficients of what no other columns span."""
        fit, found = self.whole.fit, []
        for index, member in enumerate(self.whole.members):
            own = self.whole.columns_of(index)
            along = np.linalg.solve(fit.covariance[own, own], fit.values[own])
            found.append((member.cause.traits.linearisation_error, fit.covariance[:, own] @ along))
        return found

    @cached_property
    def _rows(self) -> tuple[JointRows, ...]:
        return append_columns(self.fitter.rows.fitted, self.fitter.columns(self.whole.members))

    def _products(self, joint: int, columns: Matrix) -> tuple[SquareMatrix, Vector]:
        """Give products of white columns with each other and with the residual, beside all that is fitted."""
        fit = self.whole.fit
        part = fit.joints[joint]
        white = part.nuisance.without_nuisance(part.white(columns))
        cross = np.zeros((len(fit.values), white.shape[1]))
        cross[part.acting] = part.columns.T @ white
        return white.T @ white - cross.T @ fit.solve(cross), white.T @ fit.left[joint]


def smooth_functions(dataset: Dataset, point: Prediction, joint: int) -> Mapping[str, Matrix]:
    """Give the functions of the motion by what they are of, rows x functions, all of about unit size."""
    state, time = dataset.state, dataset.time
    speed = state.velocity / _size(state.velocity)
    way = np.tanh(STEEP * speed)
    angles = np.hstack([np.sin(state.position), np.cos(state.position)])
    own = angles[:, [joint, joint + dataset.joints]]
    others = np.delete(angles, [joint, joint + dataset.joints], axis=1)
    load = point.load(state)[:, [joint]]
    load = load / _size(load)
    clock = 2.0 * (time - time.min())[:, None] / np.ptp(time) - 1.0
    course = np.hstack([clock, clock**2, np.sin(np.pi * clock), np.cos(np.pi * clock)])
    rate = np.gradient(load, axis=0)
    rate[dataset.starts | np.roll(dataset.starts, -1)] = 0.0
    return {
        "the angles of all joints": np.hstack([angles, own[:, :1] * others, own[:, 1:] * others]),
        "speeds and angles": np.hstack([speed, way, speed[:, [joint]] * angles, way[:, [joint]] * angles]),
        "time": np.hstack([course, load * course, speed[:, [joint]] * course, way[:, [joint]] * course]),
        "the rate of its load": rate / _size(rate),
    }


@dataclass(frozen=True, eq=False)
class Process:
    """Hold normal coefficients of the likeliest variance.

    `penalty` is what the statistic has less than twice the rise of the log-likelihood at their mean.
    """

    statistic: float
    mean: Vector
    penalty: float


def likeliest_process(gram: SquareMatrix, slope: Vector) -> Process:
    """Give the coefficients' likelihood ratio statistic over none, and their mean.

    Parameters
    ----------
    gram, slope
        Products of white columns with each other and with what is left, in units of the noise.

    Examples
    --------
    Of one column, whose estimate is five standard deviations large, or as large as noise makes it:

    >>> round(likeliest_process(np.eye(1), np.array([5.0])).statistic)
    21
    >>> round(likeliest_process(np.eye(1), np.array([1.0])).statistic)
    0
    """
    sizes, axes = np.linalg.eigh(gram)
    sizes, along = np.maximum(sizes, 0.0), axes.T @ slope
    variances = VARIANCES[:, None] / max(float(np.mean(sizes)), np.finfo(float).tiny)
    shrunk, volume = variances / (1.0 + variances * sizes), np.log1p(variances * sizes)
    statistics = np.sum(along**2 * shrunk - volume, axis=1)
    best = int(np.argmax(statistics))
    mean = shrunk[best] * along
    penalty = float(np.sum(mean**2) / variances[best, 0] + np.sum(volume[best]))
    return Process(max(float(statistics[best]), 0.0), axes @ mean, penalty)


@dataclass(frozen=True)
class StructureTest:
    """Hold what a finding explains beside the structure that is left on the joints that it acts on."""

    worst: int
    """The joint, counted from 1, with the most structure over what the finding explains there."""
    of: str
    """What that structure is a function of."""
    share: float
    """Structure on all joints that have too much of it, over what the finding explains on all."""
    log10_p: float
    """Decimal logarithm of the finding's p-value by the other joints."""
    by_joint: SizeByJoint | None = None
    """Its size by each joint, where joints confirm it."""

    @property
    def doubts(self) -> bool:
        """Tell whether other joints do not show it, or much more is left, and no joints confirm it."""
        return self.by_joint is None and _is_too_much(self.share, self.log10_p)

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        """State the two."""
        return (
            Evidence(
                "Log-likelihood ratio statistic of smooth functions of the motion in what is left, most on "
                f"joint {self.worst} and of {self.of}, over that of the finding; above "
                f"{STRUCTURE_LEFT.share_of_all:g} the finding is doubtful",
                SHARE,
                self.share,
            ),
            Evidence(
                "Logarithm of the p-value by the joints on which they explain less than "
                f"{100.0 * STRUCTURE_LEFT.share:.0f} % of what the finding does; above "
                f"{np.log10(STRUCTURE_LEFT.level):.0f} it is doubtful",
                LOG_P,
                self.log10_p,
            ),
            *(() if self.by_joint is None else (self.by_joint.evidence,)),
        )


def structure_test(
    left: StructureLeft, without: Hypothesis, index: int, statistic: float
) -> StructureTest | None:
    """Test a member of a hypothesis; None where little structure is left on the joints that it acts on.

    Parameters
    ----------
    without
        The hypothesis without the member.
    statistic
        The member's likelihood ratio statistic.
    """
    fitter, whole = left.fitter, left.whole
    member = whole.members[index]
    if member.cause.traits.transient:
        return None
    gained = _gained(left, without, member)
    spoilt = [joint for joint, own in gained.items() if _is_spoilt(left, joint, own)]
    if not spoilt:
        return None
    worst = max(spoilt, key=lambda joint: left.on(joint).statistic / gained[joint])
    whole_gain = sum(gained.values())
    clean = whole_gain - sum(gained[joint] for joint in spoilt)
    share = sum(left.on(joint).statistic for joint in spoilt) / whole_gain
    log10_p = log_p_of(fitter, whole, index, min(clean, statistic)) * float(np.log10(np.e))
    test = StructureTest(worst + 1, left.on(worst).of, share, log10_p)
    return replace(test, by_joint=confirming(fitter, whole, index)) if test.doubts else test


def _gained(left: StructureLeft, without: Hypothesis, member: Candidate) -> dict[int, float]:
    """Give what a member explains on each joint that it acts on and helps."""
    by_joint = likelihood_ratio_by_joint(without, left.whole)
    acting = left.fitter.columns([member])[0]
    return {joint: float(by_joint[joint]) for joint in acting if by_joint[joint] > 0.0}


def nothing_beside_structure(findings: Sequence[Finding]) -> bool:
    """Tell whether there are findings, and too much structure is left beside each."""
    told = [{one.statistic: one.value for one in finding.evidence} for finding in findings]
    return bool(told) and all(
        SHARE in one and CONFIRMED not in one and _is_too_much(one[SHARE], one[LOG_P]) for one in told
    )


def _is_too_much(share: float, log10_p: float) -> bool:
    return share > STRUCTURE_LEFT.share_of_all or log10_p > float(np.log10(STRUCTURE_LEFT.level))


def _is_spoilt(left: StructureLeft, joint: int, gained: float) -> bool:
    """Tell whether more structure is left on a joint than noise makes, or inexact columns, or a share."""
    least = max(STRUCTURE_LEFT.statistic, STRUCTURE_LEFT.share * gained)
    return left.on(joint).statistic > max(least, left.of_inexact_columns(joint))


def _size(columns: Matrix) -> JointVector:
    """Give the RMS of every column, never zero."""
    return np.asarray(np.sqrt(np.maximum(np.mean(columns**2, axis=0), np.finfo(float).tiny)))
