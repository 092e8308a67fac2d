"""What several joints show at one size is confirmed, and what they show at different ones is not."""

import numpy as np
import pytest

from tests.core.diagnosis.scenes import fitter_of, recording, scene_of
from veritorque.core.diagnosis.causes.time_delay import TimeDelay
from veritorque.core.diagnosis.checks.between_joints import SizeByJoint, sizes_by_joint
from veritorque.core.diagnosis.checks.structure_left import StructureLeft, StructureTest, structure_test
from veritorque.core.diagnosis.search.fitter import HypothesisFitter
from veritorque.core.diagnosis.search.hypothesis import Hypothesis
from veritorque.core.diagnosis.search.likelihood_ratio import likelihood_ratio

DELAY_S = 0.01


def late(*delays: float, structure: float = 0.12) -> tuple[HypothesisFitter, Hypothesis, Hypothesis]:
    """Fit one delay of all torques to torques that are late by so many seconds each, beside a structure."""
    time, position, torque = recording()
    spoilt = np.column_stack(
        [np.interp(time - own, time, column) for own, column in zip(delays, torque.T, strict=True)]
    )
    angles = position @ np.array([[1.0, 0.7, 1.3], [1.0, 1.2, -0.8], [0.6, 1.0, 1.1]])
    spoilt += structure * torque.std(axis=0) * np.sin(1.4 * angles)
    spoilt += 0.01 * torque.std(axis=0) * np.random.default_rng(3).normal(size=torque.shape)
    fitter = fitter_of(scene_of(time, position, spoilt), (TimeDelay(),))
    none = fitter.fit(())
    (candidate,) = (each.candidate for each in fitter.scan(none))
    return fitter, none, fitter.fit((candidate,), none)


def by_joint(*delays: float, structure: float = 0.12) -> SizeByJoint:
    fitter, _, found = late(*delays, structure=structure)
    sizes = sizes_by_joint(fitter, found, 0)
    assert sizes is not None
    return sizes


def test_each_joint_tells_the_size_that_it_has():
    found = by_joint(0.5 * DELAY_S, DELAY_S, 1.5 * DELAY_S, structure=0.0)
    sizes, deviations = found.sizes / found.sizes[1], found.deviations / found.sizes[1]
    assert np.all(np.abs(sizes - [0.5, 1.0, 1.5]) < np.maximum(3.0 * deviations, 0.05))
    assert deviations.max() < 0.15
    assert not found.agree


@pytest.mark.parametrize(
    ("delays", "confirmed"),
    [((DELAY_S, DELAY_S, DELAY_S), True), ((3.0 * DELAY_S, 0.0, 0.0), False)],
    ids=["all", "one"],
)
def test_beside_much_structure_a_finding_stands_where_all_joints_show_it_alike(delays, confirmed):
    fitter, none, found = late(*delays)
    test = structure_test(StructureLeft(fitter, found), none, 0, likelihood_ratio(none, found))
    assert isinstance(test, StructureTest)
    assert by_joint(*delays).is_confirmed == confirmed
    assert test.doubts != confirmed
