"""Hold the score of a candidate to the fit with the candidate in it, and its chance to what noise does."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse import csr_array
from scipy.stats import binom, chi2, kstest

from tests.core.diagnosis.regression.gls_world import NOISE, Equations, smooth
from veritorque.core.diagnosis.regression.gls import fit
from veritorque.core.diagnosis.regression.nuisance import independent_nuisance
from veritorque.core.diagnosis.regression.rows import Columns, JointRows, append_columns
from veritorque.core.diagnosis.regression.score_test import score, score_onsets


@pytest.fixture(scope="module")
def equations() -> Equations:
    return Equations()


def random_columns(rng: np.random.Generator, count: int) -> Columns:
    """Draw a candidate that acts on one to three joints with one to three columns."""
    joints, width = rng.permutation(3)[: rng.integers(1, 4)], int(rng.integers(1, 4))
    return {int(joint): smooth(rng, count, width) for joint in joints}


def test_a_score_is_what_fitting_the_candidate_gains(equations):
    rng = np.random.default_rng(1)
    candidates = [random_columns(rng, equations.count) for _ in range(8)]
    before = fit(equations.joints, NOISE, rounds=0)
    found = score(before, equations.joints, candidates)
    for one, candidate in zip(found, candidates, strict=True):
        after = fit(equations.with_columns(candidate), NOISE, rounds=0)
        assert one.statistic == pytest.approx(
            2.0 * (after.log_likelihood - before.log_likelihood), rel=1e-6, abs=1e-6
        )
        np.testing.assert_allclose(one.values, after.values[len(before.values) :], rtol=1e-5, atol=1e-8)


def test_no_candidate_is_predicted_to_explain_more_than_is_left_where_columns_run_nearly_parallel():
    equations, rng = Equations(), np.random.default_rng(4)
    one, other = smooth(rng, equations.count, 2).T
    equations.dataset.torque[:, 0] += 100.0 * other  # 1e6 of each of the two columns, less each other
    parallel = {0: np.column_stack([one, one + 1e-4 * other])}
    rows = append_columns(equations.again(), [parallel])
    found = fit(rows, NOISE, rounds=0)
    near = {0: other[:, None] + 1e-2 * smooth(rng, equations.count, 1)}
    (judged,) = score(found, rows, [near])
    assert judged.statistic < 20.0


def test_a_score_does_not_depend_on_who_else_is_scored_or_on_units(equations):
    rng = np.random.default_rng(2)
    candidates = [random_columns(rng, equations.count) for _ in range(4)]
    before = fit(equations.joints, NOISE, rounds=0)
    together = [one.statistic for one in score(before, equations.joints, candidates)]
    in_other_units = [{joint: 1e-6 * one for joint, one in candidate.items()} for candidate in candidates]
    alone = [score(before, equations.joints, [one])[0].statistic for one in in_other_units]
    np.testing.assert_allclose(alone, together, rtol=1e-8)


def test_what_the_model_or_sticking_friction_can_stand_for_is_no_evidence(equations):
    before = fit(equations.joints, NOISE, rounds=0)
    spanned = {
        joint: one @ np.array([[1.0], [2.0], [3.0], [4.0]]) for joint, one in enumerate(equations.base)
    }
    found = score(before, equations.joints, [spanned, {1: equations.nuisance[:, :1]}])
    assert [one.statistic for one in found] == [0.0, 0.0]
    assert [one.clear_share for one in found] == [0.0, 0.0]


def with_a_rest_within_another(joints: tuple[JointRows, ...]) -> tuple[JointRows, ...]:
    """Let the first joint's friction be anything at three times, the second within a gap of the first."""
    rng, columns = np.random.default_rng(7), np.zeros((len(joints[0].rows), 3))
    for column, begin, end in ((0, 50, 90), (0, 200, 210), (1, 130, 140), (2, 135, 240)):
        columns[begin:end, column] = rng.normal(size=end - begin)
    return (replace(joints[0], nuisance=independent_nuisance(csr_array(columns))), *joints[1:])


@pytest.mark.parametrize("rests", ["moving", "resting half of the time", "resting within another rest"])
def test_columns_that_begin_to_act_at_a_row_score_as_if_they_were_written_so(equations, rests):
    rng = np.random.default_rng(6)
    joints = equations.with_rests() if rests == "resting half of the time" else equations.joints
    joints = with_a_rest_within_another(joints) if rests == "resting within another rest" else joints
    before = fit(joints, NOISE, rounds=0)
    whole = {joint: smooth(rng, equations.count, 2) for joint in (0, 2)}
    starts = np.array([0, 1, 2, 57, 58, 110, 137, 300, equations.count - 40])
    begun = [
        {joint: one * (np.arange(equations.count) >= start)[:, None] for joint, one in whole.items()}
        for start in starts
    ]
    written = score(before, joints, begun)
    for at_once, one in zip(score_onsets(before, joints, whole, starts), written, strict=True):
        assert at_once.statistic == pytest.approx(one.statistic, rel=1e-6, abs=1e-6)
        np.testing.assert_allclose(at_once.values, one.values, rtol=1e-5, atol=1e-8)


def test_where_nothing_is_hidden_and_the_noise_is_known_chances_are_uniform():
    rng = np.random.default_rng(3)
    chances = []
    for seed in range(12):
        equations = Equations(100 + seed)
        candidates = [random_columns(rng, equations.count) for _ in range(25)]
        found = score(fit(equations.joints, NOISE, rounds=0), equations.joints, candidates)
        widths = [next(iter(one.values())).shape[1] for one in candidates]
        chances += [chi2.sf(one.statistic, width) for one, width in zip(found, widths, strict=True)]
    assert kstest(chances, "uniform").pvalue > 1e-3


def test_where_nothing_is_hidden_and_the_noise_was_learned_small_chances_stay_rare():
    rng = np.random.default_rng(4)
    low, tries = 0, 0
    for seed in range(12):
        equations = Equations(200 + seed)
        candidates = [{int(rng.integers(3)): smooth(rng, equations.count, 1)} for _ in range(50)]
        found = score(fit(equations.joints), equations.joints, candidates)
        low += sum(one.statistic > chi2.isf(0.01, 1) for one in found)
        tries += len(found)
    # Twice the promised rate would be seen: the chance of so few is then one in a thousand or less.
    assert low <= binom.isf(1e-3, tries, 0.01)


def test_an_effect_raises_the_score_of_its_own_column_above_all_others():
    rng = np.random.default_rng(5)
    shapes = smooth(rng, Equations().count, 20)
    effect = np.zeros((len(shapes), 3))
    effect[:, 1] = 0.6 * shapes[:, 7]
    equations = Equations(effect=effect)
    candidates = [{joint: shapes[:, [place]]} for joint in range(3) for place in range(20)]
    found = [one.statistic for one in score(fit(equations.joints), equations.joints, candidates)]
    assert int(np.argmax(found)) == 27
    assert found[27] > 2.0 * sorted(found)[-2]
