"""Hold whole diagnoses to what their words promise: a name with its evidence, or silence."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from tests.core.diagnosis.residual.worlds import EXAMPLE, world
from tests.core.diagnosis.scenes import Effect, Scene, fitter_of, measured_arm
from veritorque.core.diagnosis import diagnose as diagnosing
from veritorque.core.diagnosis.causes.registry import CAUSES
from veritorque.core.diagnosis.checks.reservations import SetupDoubts, as_doubtful, with_reservations
from veritorque.core.diagnosis.diagnose import diagnose
from veritorque.core.diagnosis.problem import DiagnosisProblem
from veritorque.core.diagnosis.result import Diagnosis
from veritorque.core.diagnosis.search.hypothesis import Candidate
from veritorque.core.diagnosis.search.restarts import bic
from veritorque.core.diagnosis.search.state import SearchState
from veritorque.core.diagnosis.search.stepwise import search_stepwise
from veritorque.core.extension.cure import corrections, extended_base, input_note
from veritorque.core.log.reader import read_log
from veritorque.core.reduction.base import base_model
from veritorque.core.regressor.columns import ColumnPlan

UNEVEN = 0.15
"""Half the difference of viscous friction between the directions of joint 2, N m s/rad."""


def hidden(state):
    return UNEVEN * np.abs(state.velocity) * [0.0, 1.0, 0.0]


def sprung(state):
    return 3.0 * state.position * [1.0, 0.0, 0.0]


def foreign(state):
    """Drag the second joint by the product of its neighbours' speeds, as no listed cause does."""
    return 0.3 * (state.velocity[:, 0] * state.velocity[:, 2])[:, None] * [0.0, 1.0, 0.0]


def asked(scene: Scene) -> DiagnosisProblem:
    model = scene.operating_point.model
    plan = ColumnPlan(model, base_model(model).kept)
    return DiagnosisProblem(
        plan, (scene.dataset.motions[0].log,), frozenset({(0, 4), (0, 9), (0, 14), (0, 19)}), 20
    )


@cache
def diagnosed(effect: Effect | None) -> Diagnosis:
    return diagnose(asked(measured_arm(effect)))


def test_nothing_is_found_in_the_shipped_log_of_an_arm_that_is_as_described():
    held = frozenset((0, block) for block in (4, 9, 14, 19))
    found = diagnose(DiagnosisProblem(world().plan, (read_log(EXAMPLE),), held, 20))
    assert (found.verdict, found.findings) == ("nothing_found", ())


def test_nothing_is_corrected_where_nothing_is_found():
    found = diagnosed(None)
    assert (found.verdict, found.findings, corrections(found)) == ("nothing_found", (), ())


def test_causes_are_found_where_one_is_more_likely_right_than_not():
    found = diagnosed(hidden)
    kept = with_reservations(found, SetupDoubts(), doubted=False)
    assert (kept.verdict, kept.findings) == ("causes_found", found.findings)
    doubtful = replace(found, findings=tuple(map(as_doubtful, found.findings)))
    assert with_reservations(doubtful, SetupDoubts(), doubted=False).verdict == "unexplained"


def test_no_cause_is_surer_than_the_set_up_that_it_is_found_in():
    found = with_reservations(diagnosed(hidden), SetupDoubts(confidence=0.7), doubted=False)
    assert [one.confidence for one in found.findings] == [0.7] * len(diagnosed(hidden).findings)
    assert found.verdict == "causes_found"
    guessed = with_reservations(diagnosed(hidden), SetupDoubts(confidence=0.5), doubted=False)
    assert guessed.verdict == "unexplained"


@pytest.mark.parametrize(("is_slow", "most"), [(True, 0.5), (False, 1.0)], ids=["slow", "white noise"])
def test_findings_are_doubtful_where_more_than_half_of_a_torque_stays_and_is_no_noise(is_slow, most):
    found = diagnosed(hidden)
    dataset, rng = found.dataset, np.random.default_rng(3)
    waves = np.sqrt(2.0) * np.sin(dataset.motion_band_hz * np.pi * dataset.time)
    left = found.residual_after.copy()
    size = 0.7 * np.sqrt(np.mean(dataset.torque[dataset.usable[:, 0], 0] ** 2))
    left[:, 0] = size * (waves if is_slow else rng.normal(size=len(waves)))
    kept = with_reservations(
        replace(found, residual_after=left, predictable=()), SetupDoubts(), doubted=False
    )
    assert [one.confidence for one in kept.findings] == [min(one.confidence, most) for one in found.findings]


def test_a_cause_that_a_corrected_log_does_not_tell_from_others_is_doubtful():
    sound = diagnosed(hidden)
    (cause,) = {one.cause for one in sound.findings}
    for causes, most in (({cause}, 0.5), ({"another"}, 1.0)):
        found = with_reservations(sound, SetupDoubts(causes=frozenset(causes)), doubted=False)
        assert [one.confidence for one in found.findings] == [
            min(one.confidence, most) for one in sound.findings
        ]


def test_a_finding_brings_everything_that_decided():
    found = diagnosed(hidden)
    assert found.verdict == "causes_found"
    (one,) = found.findings
    assert (one.cause, one.joints, one.cure) == ("friction_asymmetric", (2,), "term")
    assert 0.5 < one.confidence <= 1.0
    assert one.p_value < 1e-3
    assert 0.0 < one.explained_fraction < 1.0
    assert one.gain.interval_95[0] > 0.0
    assert all(np.isfinite(part.value) for part in one.evidence if part.statistic != "criterion difference")
    assert {alternative.cause for alternative in (*one.ambiguous_with, *one.refuted)}.isdisjoint({one.cause})
    assert all(alternative.why for alternative in (*one.ambiguous_with, *one.refuted))
    assert all(alternative.separating_experiment for alternative in one.ambiguous_with)
    (size,) = one.quantities
    assert abs(size.value - UNEVEN) < 3.0 * size.standard_deviation


def jerked(state):
    """Pull at the second joint for less than a second, all at once, as no contact swells and fades."""
    return 4.0 * ((state.time > 6.0) & (state.time < 6.8))[:, None] * [0.0, 1.0, 0.0]


def sprung_and_jerked_where_held_out(state):
    jerk = 0.5 * ((state.time > 4.1) & (state.time < 4.9))
    return 3.0 * state.position * [1.0, 0.0, 0.0] + jerk[:, None] * [0.0, 1.0, 0.0]


def test_other_blocks_are_held_out_from_the_search_where_one_of_them_hides_what_no_other_shows():
    found, asked_for = diagnosed(sprung_and_jerked_where_held_out), asked(measured_arm()).held_out
    assert found.dataset.held_out_blocks.isdisjoint(asked_for)
    assert len(found.dataset.held_out_blocks) == len(asked_for)
    assert {step.action for step in found.steps} == {"added"}


def test_what_happens_once_and_has_no_listed_shape_is_never_called_nothing():
    found = diagnosed(jerked)
    assert found.verdict == "unexplained"
    assert "Burst in the residual" in found.unnamed_pattern.statement


def test_a_finding_states_its_gain_on_held_out_rows_beside_the_expected_one():
    (one,) = diagnosed(hidden).findings
    (holdout,) = (part for part in one.evidence if part.statistic == "held-out likelihood ratio")
    expected = float(holdout.statement.split("there, ")[1].split()[0])
    assert 0.6 < holdout.value / expected < 1.6


def test_the_curve_of_a_finding_shows_what_it_takes_away():
    curve = diagnosed(hidden).findings[0].curve
    assert (curve.coordinate, curve.joint) == ("velocity", 2)
    assert np.linalg.norm(curve.after) < 0.3 * np.linalg.norm(curve.before)


def test_only_the_joint_of_the_finding_changes_much():
    gain = diagnosed(hidden).findings[0].gain
    assert gain.after[1] < 0.9 * gain.before[1]
    np.testing.assert_allclose(gain.after[[0, 2]], gain.before[[0, 2]], rtol=0.02)


def test_the_correction_joins_the_model_under_its_own_name():
    found = diagnosed(hidden)
    (term,) = corrections(found)
    assert input_note(found) == ""
    base = base_model(measured_arm().operating_point.model)
    whole = extended_base(base, (term,))
    assert len(whole.kept) == len(base.kept) + 1
    assert whole.model.terms[-1].name == term.name


def test_the_same_logs_give_the_same_diagnosis():
    first, second = diagnosed(hidden), diagnose(asked(measured_arm(hidden)))
    assert [one.statement for one in second.findings] == [one.statement for one in first.findings]
    assert [one.confidence for one in second.findings] == [one.confidence for one in first.findings]
    assert [one.share for one in second.predictable] == [one.share for one in first.predictable]
    np.testing.assert_array_equal(second.residual_after, first.residual_after)


def test_a_pattern_that_no_listed_cause_has_is_told_without_a_name_and_makes_the_verdict():
    found = diagnosed(foreign)
    assert (found.verdict, found.findings, corrections(found)) == ("unexplained", (), ())
    assert found.unnamed_pattern.joint == 2
    assert "the product of the speeds of joints 1 and 3" in found.unnamed_pattern.statement
    assert found.unnamed_pattern.log10_p < -10.0


def test_no_unnamed_pattern_is_reported_where_nothing_is_left():
    assert diagnosed(None).unnamed_pattern is None
    assert diagnosed(hidden).unnamed_pattern is None


@pytest.mark.parametrize("joint", [1, 2, 3])
def test_the_explainable_variance_is_reported_for_every_joint(joint):
    (one,) = [part for part in diagnosed(None).predictable if part.joint == joint]
    assert one.interval[0] <= one.share <= one.interval[1]


@cache
def searched() -> SearchState:
    return search_stepwise(fitter_of(measured_arm(lambda state: hidden(state) + sprung(state)), CAUSES))


def of_members(members: tuple[Candidate, ...]) -> SearchState:
    found = searched()
    return replace(found, chosen=found.fitter.fit(members, found.none))


@pytest.mark.parametrize("stays", ["both", "weaker"])
def test_a_continued_search_replaces_what_was_kept_only_where_its_comparison_leaves_more(monkeypatch, stays):
    found = searched()
    one, other = found.chosen.members
    weaker, stronger = sorted((of_members((one,)), of_members((other,))), key=lambda state: bic(state.chosen))
    kept = replace(stronger, excluded=frozenset({("time_delay", (1,))}))
    left = found if stays == "both" else weaker
    answers = iter([(kept, []), (left, [])])
    monkeypatch.setattr(diagnosing, "compare_alternatives", lambda _: next(answers))
    monkeypatch.setattr(diagnosing, "continue_search", lambda _: found)
    given = diagnosing.compare(found)[0].chosen.members
    assert given == (found if stays == "both" else kept).chosen.members
