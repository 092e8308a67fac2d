"""A torque that switches by itself is noticed; noise of any kind is not taken for it."""

import numpy as np
import pytest

from tests.core.diagnosis.made_up import JOINT, nothing_found, on_joint
from tests.core.diagnosis.scenes import fitter_of, measured_arm
from veritorque.core.diagnosis.checks.change_points import switching_candidates
from veritorque.core.diagnosis.checks.kurtosis import bounded_residual, kurtosis
from veritorque.core.diagnosis.checks.lack_of_fit import best_unnamed_pattern
from veritorque.core.diagnosis.search.residuals import residual

SIZE = 0.2
"""Of the switching torque, N m."""


def switching(state):
    turns = np.random.default_rng(3).random(1 + int(state.time[-1] / 0.25)) < 0.25
    side = np.where(np.cumsum(turns) % 2, 1.0, -1.0)
    return SIZE * side[(state.time / 0.25).astype(int)]


def kept(effect, seed):
    fitter = fitter_of(measured_arm(effect, seed=seed), ())
    return bounded_residual(fitter.dataset, residual(fitter, nothing_found(fitter)))


@pytest.mark.parametrize("seed", [6, 7])
def test_a_torque_that_switches_by_itself_keeps_to_levels(seed):
    found = kept(on_joint(switching), seed)
    assert found.joint == JOINT
    assert "switches between levels by itself" in found.statement
    assert found.log10_p < -6.0


@pytest.mark.parametrize("seed", [6, 7, 8])
def test_noise_keeps_to_no_levels(seed):
    assert kept(None, seed) is None


def switched(effect, seed):
    fitter = fitter_of(measured_arm(effect, seed=seed), ())
    none = nothing_found(fitter)
    return best_unnamed_pattern(fitter, none, switching_candidates(fitter, none, residual(fitter, none)))


@pytest.mark.parametrize("share", [1.0, 0.25])
def test_what_switches_is_told_with_its_joint_and_its_size(share):
    found = switched(on_joint(lambda state: share * switching(state)), 6)
    (member,), (value,) = found.members, found.fit.values[found.columns_of(0)]
    assert member.site == (JOINT,)
    assert abs(value) == pytest.approx(share * SIZE, rel=0.1)
    assert "two levels between which it switches by itself" in member.cause.statement(found.solved(0))


@pytest.mark.parametrize("seed", range(6))
def test_noise_does_not_switch(seed):
    assert switched(None, seed) is None


@pytest.mark.parametrize(("draw", "size"), [("normal", 3.0), ("laplace", 6.0), ("uniform", 1.8)])
def test_the_kurtosis_of_a_distribution_lies_within_its_deviation(draw, size):
    # Johnson, Kotz & Balakrishnan, Continuous Univariate Distributions (1994): 3, 6 and 9 / 5.
    series = getattr(np.random.default_rng(1), draw)(size=20_000)
    found, deviation = kurtosis(series, np.arange(len(series)) // 500)
    assert abs(found - size) < 3.0 * deviation
    assert deviation < 0.15 * size
