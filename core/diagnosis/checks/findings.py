"""Compose the finding of every cause: its size, the evidence, its gain and its figure."""

from collections.abc import Sequence

import numpy as np

from ...arrays import JointSeries
from ..causes.protocol import Cause, Setting
from ..causes.sample_check import SampleCheck, SampleFinding
from ..dataset.dataset import Dataset
from ..result import Evidence, Finding
from ..search.fitter import HypothesisFitter
from ..search.holdout import expected_holdout_likelihood_ratio, holdout_likelihood_ratio
from ..search.hypothesis import Hypothesis
from ..search.likelihood_ratio import log_p_of
from ..search.residuals import residual
from ..search.state import SearchState
from ..thresholds.checks import BLOCK_SCATTER, CONFIDENCE
from .alternatives import Comparison
from .between_joints import confirming
from .between_logs import BetweenLogs
from .block_scatter import block_log_p
from .body_or_gain import gain_evidence, is_rather_a_gain
from .command import command_evidence, contradicted_by_command
from .confidence import confidence, predictors
from .figure import curve
from .gain import gain
from .instruments import Instruments
from .one_size import several_sizes
from .plausible_size import has_known_size
from .position_noise import NoiseTest, noise_test
from .spring_resonance import contradicts_resonance, resonance_evidence
from .structure_left import StructureLeft, StructureTest, structure_test


def finding(
    found: SearchState,
    own: Comparison,
    after: JointSeries,
    unnamed: float,
    checks: tuple[Instruments, StructureLeft],
    logs: BetweenLogs,
) -> Finding:
    """Compose the finding of one member of the chosen hypothesis.

    Parameters
    ----------
    own
        Its comparison with its alternatives.
    after
        What the whole hypothesis leaves of the torque, N m or N.
    unnamed
        Likelihood ratio statistic of an unnamed pattern in what is left: where it is larger than the
        finding's, the finding may be no more than its trace.
    checks
        What estimates the members by instrumental variables, and what tests the residual for structure.
    logs
        What estimates the members in each log.
    """
    fitter, chosen, index = found.fitter, found.chosen, own.index
    dataset, left = fitter.dataset, (_baseline(fitter, chosen, index, own), after)
    member, solved = chosen.members[index], chosen.in_joint_units(index, fitter.dataset.robot)
    cause = member.cause
    columns = fitter.columns([member])[0]
    joints = tuple(sorted(columns))
    mask = dataset.usable & dataset.held_out[:, None]
    measured = gain(left[0], left[1], mask, dataset.block_of_all, joints)
    log_p = log_p_of(fitter, chosen, index, own.statistic)
    over_unnamed = _lead_over_unnamed(fitter, chosen, own)
    margin = min(own.margin, over_unnamed, own.statistic - unnamed)
    evidence = predictors(own.statistic, margin, measured)
    at = Setting(dataset, fitter.operating_point, member.site, member.scalars)
    scattered = _between_blocks(found, own, logs)
    in_log = logs.least_size(index)
    represented = cause.represented(at, solved) and has_known_size(cause, solved)
    several = several_sizes(fitter, chosen, index, logs)
    tests = _tests(fitter, own, checks)
    resonance = resonance_evidence(cause.id, at, solved)
    beside = gain_evidence(fitter, own.without, member)
    doubts = (
        is_rather_a_gain(beside),
        min(own.margin, over_unnamed) < 0.0,
        not represented,
        _scatters(scattered),
        in_log is not None and in_log.is_missing,
        bool(several),
        *(test.doubts for test in tests),
        contradicted_by_command(dataset.motions, cause.id, member.site, float(solved.values[0])),
        contradicts_resonance(resonance, solved),
    )
    sure = confidence(evidence)
    return Finding(
        cause=cause.id,
        title=cause.title,
        joints=member.site or tuple(joint + 1 for joint in joints),
        cure=cause.cure,
        statement=cause.statement(solved),
        quantities=cause.quantities(solved),
        confidence=min(sure, CONFIDENCE.doubtful) if any(doubts) else sure,
        predictors=evidence,
        p_value=float(np.exp(log_p)),
        explained_fraction=_fraction(left, dataset.usable & ~dataset.held_out[:, None], joints),
        evidence=(
            *_evidence(own, log_p, member.trials),
            *_on_holdout(fitter, chosen, index, own),
            *scattered,
            *(() if in_log is None else (in_log.evidence,)),
            *several,
            *(one for test in tests for one in test.evidence),
            *resonance,
            *beside,
            *command_evidence(dataset.motions, cause.id, member.site),
        ),
        ambiguous_with=own.ambiguous,
        refuted=own.refuted,
        gain=measured,
        curve=curve(dataset, fitter.operating_point, chosen, index, columns, left),
        member=member,
    )


def _lead_over_unnamed(fitter: HypothesisFitter, chosen: Hypothesis, own: Comparison) -> float:
    """Give a member's lead over unnamed patterns; infinite beside one where joints confirm the member."""
    if own.over_unnamed < 0.0 and own.stays_beside_unnamed and confirming(fitter, chosen, own.index):
        return np.inf
    return own.over_unnamed


def _tests(
    fitter: HypothesisFitter, own: Comparison, checks: tuple[Instruments, StructureLeft]
) -> tuple[NoiseTest | StructureTest, ...]:
    """Test for noise of the positions, and for structure that is left."""
    found = (
        noise_test(fitter, own.without, checks[0], own.index, own.statistic),
        structure_test(checks[1], own.without, own.index, own.statistic),
    )
    return tuple(test for test in found if test is not None)


def _evidence(own: Comparison, log_p: float, trials: float) -> tuple[Evidence, ...]:
    return (
        Evidence(
            "Log-likelihood ratio statistic when it enters the model, with the noise estimated again",
            "likelihood ratio",
            own.statistic,
        ),
        Evidence(
            f"Logarithm of the p-value, corrected for {trials:.3g} scanned values and all other candidates",
            "log10 p",
            log_p / float(np.log(10.0)),
        ),
        Evidence(
            "Delta BIC to the best alternative; below 6 the two are undecided",
            "criterion difference",
            own.margin,
        ),
        *_over_unnamed(own),
    )


def _between_blocks(found: SearchState, own: Comparison, logs: BetweenLogs) -> tuple[Evidence, ...]:
    """Give its p-value by the scatter between blocks; not of a transient cause, which is in few of them."""
    if own.member.cause.traits.transient:
        return ()
    log_p = block_log_p(found.fitter, found.chosen, own.index, own.statistic, logs.equations)
    return (
        Evidence(
            "Logarithm of the p-value by the scatter between parts of the log, corrected in the same way; "
            f"above {np.log10(BLOCK_SCATTER.level):.0f} the finding is doubtful",
            "log10 p between blocks",
            log_p / float(np.log(10.0)),
        ),
    )


def _scatters(between_blocks: tuple[Evidence, ...]) -> bool:
    return any(one.value > float(np.log10(BLOCK_SCATTER.level)) for one in between_blocks)


def _on_holdout(
    fitter: HypothesisFitter, chosen: Hypothesis, index: int, own: Comparison
) -> tuple[Evidence, ...]:
    """Give its statistic on held-out rows, each weighted by the noise there; not of a transient cause.

    The RMS error, which `gain` is of, may be dominated by slow torque.
    """
    if own.member.cause.traits.transient:
        return ()
    expected = expected_holdout_likelihood_ratio(fitter, own.without, chosen, index)
    return (
        Evidence(
            "Log-likelihood ratio statistic on held-out data; as far as it acts there, "
            f"{expected:.0f} is expected",
            "held-out likelihood ratio",
            holdout_likelihood_ratio(fitter, own.without, chosen, index),
        ),
    )


def _over_unnamed(own: Comparison) -> tuple[Evidence, ...]:
    """Compare it with unnamed patterns, where one explains a part of it."""
    if not np.isfinite(own.over_unnamed):
        return ()
    statement = "Delta BIC to the best unnamed pattern; below 0 the finding is doubtful"
    if own.over_unnamed < 0.0 and own.stays_beside_unnamed:
        statement += ", unless joints confirm it: it explains as much beside the pattern"
    return (Evidence(statement, "lead over unnamed patterns", own.over_unnamed),)


def _fraction(left: tuple[JointSeries, JointSeries], mask: np.ndarray, joints: Sequence[int]) -> float:
    """Give the share of the residual's mean square that a finding explains on the joint it helps most."""
    sums = [(series**2 * mask).sum(axis=0)[list(joints)] for series in left]
    return float(np.max(1.0 - sums[1] / np.maximum(sums[0], 1e-300)))


def sample_finding(cause: SampleCheck | Cause, found: SampleFinding, dataset: Dataset) -> Finding:
    """Compose the finding of a sample check."""
    sure = 1.0 - found.p_value
    return Finding(
        cause=cause.id,
        title=cause.title,
        joints=found.site or tuple(range(1, dataset.joints + 1)),
        cure=cause.cure,
        statement=found.statement,
        quantities=found.quantities,
        confidence=float(min(sure, CONFIDENCE.certain)),
        p_value=found.p_value,
        explained_fraction=float(np.clip(np.max(found.residual_share), 0.0, 1.0)),
        evidence=(Evidence("Statistic of the sample check", "raw check", found.statistic),),
        ambiguous_with=(),
        refuted=(),
        gain=None,
        curve=None,
        member=None,
        predictors=None,
    )


def _baseline(fitter: HypothesisFitter, chosen: Hypothesis, index: int, own: Comparison) -> JointSeries:
    """Give the residual without a finding: all else fitted again, or, against a reference, kept as it is."""
    return residual(fitter, own.without) if fitter.prior is None else residual(fitter, chosen, (index,))
