"""One number for the whole robot is sure only where joints and parts of the log give the same."""

from dataclasses import replace

import numpy as np
import pytest

from tests.core.diagnosis.scenes import fitter_of, recording, scene_of
from veritorque.core.diagnosis.causes.time_delay import TimeDelay
from veritorque.core.diagnosis.checks.alternatives import compare_alternatives
from veritorque.core.diagnosis.checks.between_logs import BetweenLogs
from veritorque.core.diagnosis.checks.findings import finding
from veritorque.core.diagnosis.checks.instruments import Instruments
from veritorque.core.diagnosis.checks.one_size import SEVERAL, has_several_sizes, several_sizes
from veritorque.core.diagnosis.checks.structure_left import StructureLeft
from veritorque.core.diagnosis.result import Evidence
from veritorque.core.diagnosis.search.fitter import HypothesisFitter
from veritorque.core.diagnosis.search.hypothesis import Hypothesis
from veritorque.core.diagnosis.search.residuals import residual
from veritorque.core.diagnosis.search.stepwise import search_stepwise
from veritorque.core.diagnosis.thresholds.checks import CONFIDENCE, ONE_SIZE

DELAY_S = 0.01


def delayed(delays: np.ndarray, noise: float) -> tuple[HypothesisFitter, Hypothesis]:
    """Fit one delay to torques that are late by so many seconds, by row and joint."""
    time, position, torque = recording()
    late = np.column_stack(
        [np.interp(time - own, time, column) for own, column in zip(delays.T, torque.T, strict=True)]
    )
    late += noise * torque.std(axis=0) * np.random.default_rng(3).normal(size=torque.shape)
    fitter = fitter_of(scene_of(time, position, late), (TimeDelay(),))
    none = fitter.fit(())
    (candidate,) = (each.candidate for each in fitter.scan(none))
    return fitter, fitter.fit((candidate,), none)


def told(fitter: HypothesisFitter, found: Hypothesis) -> tuple[Evidence, ...]:
    """Give the evidence of several sizes."""
    return several_sizes(fitter, found, 0, BetweenLogs(fitter, found))


@pytest.mark.parametrize("noise", [0.002, 0.02])
@pytest.mark.parametrize(
    ("by_joint", "by_time", "several"),
    [
        ((1.0, 1.0, 1.0), (1.0, 1.0), ""),
        ((1.1, 0.9, 1.0), (0.95, 1.05), ""),
        ((0.25, 1.0, 1.75), (1.0, 1.0), "the joints"),
        ((1.0, 1.0, 1.0), (0.0, 2.0), "successive parts"),
    ],
    ids=["one delay", "nearly one", "channels read in turn", "clocks that drift apart"],
)
def test_a_delay_is_one_where_joints_and_parts_of_the_log_agree(by_joint, by_time, several, noise):
    course = np.linspace(*by_time, len(recording()[0]))
    found = told(*delayed(DELAY_S * course[:, None] * np.array(by_joint), noise))
    assert len(found) == bool(several)
    assert all(several in one.statement and one.statistic == SEVERAL for one in found)
    assert all(one.value < ONE_SIZE.level for one in found)


def test_what_a_cause_of_one_joint_explains_is_not_compared():
    fitter, found = delayed(
        DELAY_S * np.array([[0.25, 1.0, 1.75]]) * np.ones((len(recording()[0]), 1)), 0.002
    )
    own = replace(found, members=(replace(found.members[0], site=(1,)),))
    assert told(fitter, found)
    assert not told(fitter, own)


@pytest.mark.parametrize(("by_joint", "sure"), [((1.0, 1.0, 1.0), True), ((1.6, 1.0, 0.4), False)])
def test_a_delay_of_several_sizes_is_named_with_reserve(by_joint, sure):
    fitter, _ = delayed(DELAY_S * np.array([by_joint]) * np.ones((len(recording()[0]), 1)), 0.02)
    state, (own,) = compare_alternatives(search_stepwise(fitter))
    after, instruments = residual(state.fitter, state.chosen), Instruments(state.fitter, state.chosen)
    checks = instruments, StructureLeft(state.fitter, state.chosen)
    made = finding(state, own, after, 0.0, checks, BetweenLogs(state.fitter, state.chosen))
    assert has_several_sizes(made) != sure
    assert (made.confidence > CONFIDENCE.doubtful) == sure
