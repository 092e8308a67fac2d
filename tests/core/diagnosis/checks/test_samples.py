"""Causes are searched in torques from which dead zones were taken out, at the width that the model tells."""

import numpy as np
import pytest

from tests.core.diagnosis.causes.test_sample_checks import (
    DEAD,
    ZONES,
    looked_at,
    operating_point,
    recorded,
    with_torque,
)
from veritorque.core.diagnosis.causes.torque_dead_zone import dead_zones
from veritorque.core.diagnosis.checks.samples import check_samples
from veritorque.core.diagnosis.problem import DiagnosisProblem
from veritorque.core.log.model import JointLog
from veritorque.core.regressor.columns import all_columns

SHRINKS = "too little by as much"


def problem(log: JointLog) -> DiagnosisProblem:
    return DiagnosisProblem(all_columns(operating_point().model), (log,), frozenset(), 5)


@pytest.mark.parametrize("words", ZONES)
def test_the_torque_in_which_causes_are_searched_is_the_one_that_acted(words):
    spoilt = with_torque(ZONES[words][0])
    asked, faults, fitter = check_samples(problem(spoilt))
    assert [(zone.joint, zone.shrinks) for zone in asked.zones] == [(0, words == SHRINKS)]
    assert [one.cause for one in faults] == ["torque_dead_zone"]
    found, plain = fitter.dataset, check_samples(problem(recorded()))[2].dataset
    both = found.usable & plain.usable
    difference = np.where(both, found.torque - plain.torque, 0.0)
    assert both[:, 0].sum() > 0.5 * plain.usable[:, 0].sum()
    np.testing.assert_array_equal(difference[:, 1], 0.0)
    assert np.abs(difference).max() < 0.02 * DEAD


def test_the_model_tells_the_width_better_than_the_zeros_do():
    spoilt = with_torque(ZONES[SHRINKS][0])
    (counted,) = dead_zones(looked_at(spoilt))
    asked, (fault,), _ = check_samples(problem(spoilt))
    (width,) = fault.quantities
    assert width.value == pytest.approx(asked.zones[0].half)
    assert width.standard_deviation < 0.3 * counted.deviation
    assert abs(width.value - DEAD) < 3.0 * width.standard_deviation


def lost_at_small_torques() -> JointLog:
    """Lose eleven samples at each of six passages through zero, and none at the others."""

    def lost(torque: np.ndarray) -> np.ndarray:
        passages = np.flatnonzero(np.diff(np.sign(np.convolve(torque, np.ones(9), "same"))))[2:-2]
        chosen = passages[:: max(len(passages) // 6, 1)][:6]
        near = np.abs(np.arange(len(torque))[:, None] - chosen).min(axis=1) <= 5
        return np.where(near, 0.0, torque)

    return with_torque(lost)


def test_zeros_beside_which_the_model_misses_no_torque_are_no_dead_zone():
    log = lost_at_small_torques()
    assert [zone.shrinks for zone in dead_zones(looked_at(log))] == [True]
    asked, faults, _ = check_samples(problem(log))
    assert asked.zones == ()
    assert faults == []
