"""The search names what is there and nothing else, and corrects a wrong start."""

from dataclasses import replace
from functools import cache
from itertools import cycle

import numpy as np
import pytest

from tests.core.diagnosis.made_up import candidate, made_up, nothing_found
from tests.core.diagnosis.scenes import Effect, fitter_of, measured_arm
from tests.core.diagnosis.waves import wave_cause, wave_effect
from veritorque.core.diagnosis.causes import imitation
from veritorque.core.diagnosis.causes.imitation import IMITATIONS, Imitation
from veritorque.core.diagnosis.causes.masking import EXCLUDED_BY, MASKED_BY, Masking
from veritorque.core.diagnosis.causes.protocol import SearchTraits
from veritorque.core.diagnosis.causes.registry import BY_ID, CAUSES
from veritorque.core.diagnosis.checks.alternatives import compare_alternatives, compare_member, refit_member
from veritorque.core.diagnosis.search import fitter as fitter_module
from veritorque.core.diagnosis.search import stepwise as search
from veritorque.core.diagnosis.search.entry_test import is_significant, passes_exit_test
from veritorque.core.diagnosis.search.likelihood_ratio import bic_gain, likelihood_ratio, log_p
from veritorque.core.diagnosis.search.lr_bound import predicted_likelihood_ratios
from veritorque.core.diagnosis.search.residuals import residual
from veritorque.core.diagnosis.search.state import SearchState
from veritorque.core.diagnosis.search.stepwise import confirm, search_stepwise
from veritorque.core.diagnosis.thresholds.search import ENTRY, SEARCH

QUICK, NEARLY_QUICK, QUICKER, SLOW = 7.0, 7.3, 11.0, 4.0
"""Waves per radian: none of them is gravity."""

CLEAN = None


def uneven(state):
    return 0.15 * np.abs(state.velocity) * [0.0, 1.0, 0.0]


def sprung(state):
    return 3.0 * state.position * [1.0, 0.0, 0.0]


def both(state):
    return uneven(state) + sprung(state)


def names(selection: SearchState) -> list[tuple[str, tuple[int, ...]]]:
    return sorted(one.key for one in selection.chosen.members)


def uneven_throughout(state):
    return 0.15 * np.abs(state.velocity) + sprung(state)


@cache
def searched(effect: Effect | None, seed: int) -> SearchState:
    return search_stepwise(fitter_of(measured_arm(effect, seed=seed), CAUSES))


@pytest.mark.parametrize("seed", range(4))
def test_nothing_is_named_where_nothing_is_hidden(seed):
    assert names(searched(CLEAN, seed)) == []


@pytest.mark.parametrize(
    ("effect", "hidden"),
    [
        (uneven, [("friction_asymmetric", (2,))]),
        (sprung, [("spring_compensator", (1,))]),
        (both, [("friction_asymmetric", (2,)), ("spring_compensator", (1,))]),
    ],
    ids=["uneven", "sprung", "both"],
)
def test_what_is_hidden_is_named_with_its_joint_and_nothing_else(effect, hidden):
    assert names(searched(effect, 5)) == hidden


def test_the_size_that_is_found_is_the_size_that_was_hidden():
    found = searched(uneven, 5).chosen.solved(0)
    assert abs(found.values[0] - 0.15) < 3.0 * np.sqrt(found.covariance[0, 0])


def shoved(state):
    """Push all joints for most of a second."""
    during = (state.time > 6.0) & (state.time < 6.8)
    return during[:, None] * np.array([1.0, -0.8, 0.5])


def spiky(state):
    """Spoil four samples of one joint's torque, close to each other."""
    out = np.zeros_like(state.position)
    out[np.searchsorted(state.time, [6.0, 6.1, 6.22, 6.3]), 1] = [8.0, 9.0, 7.0, 8.0]
    return out


@pytest.mark.parametrize(
    ("effect", "named"), [(shoved, ["external_contact"]), (spiky, [])], ids=["shoved", "spiky"]
)
def test_a_push_that_lasts_is_an_event_and_a_few_spikes_are_none(effect, named):
    found = search_stepwise(fitter_of(measured_arm(effect), (BY_ID["external_contact"],)))
    assert [name for name, _ in names(found)] == named


def only_before_the_held_out_rows(state):
    """Put a large wave where rows are fitted and its opposite where they are not; a small one all along."""
    large = wave_effect({QUICK: 2.0})(state) * np.where(state.time < 16.0, 1.0, -1.0)[:, None]
    return large + wave_effect({QUICKER: 0.06})(state)


def test_a_cause_that_looks_small_beside_one_that_held_out_rows_refute_is_found_all_the_same():
    causes = (wave_cause("quick", {QUICK: 1.0}), wave_cause("quicker", {QUICKER: 1.0}))
    fitter = fitter_of(measured_arm(only_before_the_held_out_rows), causes)
    none = nothing_found(fitter)
    first, second = fitter.scan(none)
    assert first.candidate.cause.id == "quick"
    (small,) = predicted_likelihood_ratios(fitter, none, [second])
    assert ENTRY.bound_factor * small + ENTRY.bound_excess < bic_gain(
        none, fitter.fit_with(none, first.candidate)
    )
    assert names(search_stepwise(fitter)) == [("quicker", (2,))]


def test_what_happens_at_picked_instants_takes_no_place_of_what_acts_all_the_time():
    lasting = wave_cause("lasting", {QUICK: 1.0})
    event = wave_cause("event", {QUICK: 1.0, QUICKER: 0.5})
    type(event).traits = SearchTraits(transient=True)
    effect = wave_effect({QUICK: 0.6, QUICKER: 0.3})
    alone = search_stepwise(fitter_of(measured_arm(effect), (event,)))
    assert names(alone) == [("event", (2,))]
    both = search_stepwise(fitter_of(measured_arm(effect), (lasting, event)))
    assert [(step.action, step.candidate.cause.id) for step in both.steps] == [
        ("added", "lasting"),
        ("added", "event"),
        ("dropped", "lasting"),
    ]


def test_two_that_look_better_than_each_other_are_swapped_there_and_back_at_most(monkeypatch):
    fitter = fitter_of(
        measured_arm(wave_effect({QUICK: 0.6})),
        (wave_cause("quick", {QUICK: 1.0}), wave_cause("nearly_quick", {NEARLY_QUICK: 1.0})),
    )
    in_turn = cycle(one.candidate for one in fitter.scan(nothing_found(fitter)))

    def other_than_the_last(fitter, now, *_given_up_and_limits):
        return None if now.members else fitter.fit_with(now, next(in_turn))

    monkeypatch.setattr(search, "best_entry", other_than_the_last)
    assert [step.action for step in search_stepwise(fitter).steps] == ["added", "swapped", "swapped"]


@cache
def misled() -> SearchState:
    """Offer two true waves, and a false one that alone explains more than either."""
    causes = (
        wave_cause("quick", {QUICK: 1.0}),
        wave_cause("quicker", {QUICKER: 1.0}),
        wave_cause("stand_in", {QUICK: 1.0, QUICKER: 1.0, SLOW: 0.5}),
    )
    return search_stepwise(fitter_of(measured_arm(wave_effect({QUICK: 0.6, QUICKER: 0.6})), causes))


def test_a_false_cause_that_comes_first_is_taken_back_when_the_true_ones_are_found():
    assert misled().steps[0].candidate.cause.id == "stand_in"
    assert names(misled()) == [("quick", (2,)), ("quicker", (2,))]
    assert {"dropped", "swapped"} & {step.action for step in misled().steps}


def test_every_step_of_the_search_is_on_record():
    added = [step.candidate.key for step in misled().steps if step.action in ("added", "swapped")]
    assert {one.key for one in misled().chosen.members} <= set(added)


@pytest.mark.parametrize(
    ("leaves", "size", "named"),
    [((), 0.03, True), (("quicker",), 0.03, False), (("quicker",), 0.6, True)],
    ids=["is another cause", "is what the first one leaves", "is as clear as the first one"],
)
def test_what_a_chosen_cause_leaves_unexplained_is_added_only_where_it_is_nearly_as_clear(
    leaves, size, named, monkeypatch
):
    causes = (wave_cause("quick", {QUICK: 1.0}), wave_cause("quicker", {QUICKER: 1.0}))
    monkeypatch.setitem(MASKED_BY, "quick", Masking(leaves, ""))
    found = search_stepwise(fitter_of(measured_arm(wave_effect({QUICK: 0.6, QUICKER: size})), causes))
    assert {name for name, _ in names(found)} == {"quick", *(["quicker"] if named else [])}


def weakly(fitter, first, second):
    """Tell whether a second cause is clear enough to be the first one, but not to be just another one."""
    now = fitter.fit((first,))
    chance = log_p(now, fitter.fit_with(now, second)) + np.log(fitter.kinds)
    return np.log(ENTRY.further_level) < chance < np.log(ENTRY.level)


def test_a_second_cause_that_owes_nothing_to_the_first_need_be_no_clearer_than_that():
    def effect(state):
        return 0.3 * sprung(state) + 0.045 * uneven(state)

    fitter = fitter_of(measured_arm(effect), CAUSES)
    found = search_stepwise(fitter)
    assert names(found) == [("friction_asymmetric", (2,)), ("spring_compensator", (1,))]
    assert weakly(fitter, *sorted(found.chosen.members, key=lambda one: one.site))


def test_one_that_shares_what_it_explains_with_the_first_has_to_be_clearer():
    causes = (wave_cause("quick", {QUICK: 1.0}), wave_cause("nearly", {NEARLY_QUICK: 1.0}))
    fitter = fitter_of(measured_arm(wave_effect({QUICK: 0.6, NEARLY_QUICK: 0.034})), causes)
    assert names(search_stepwise(fitter)) == [("quick", (2,))]
    assert weakly(fitter, *fitter.candidates)


def test_one_that_would_not_join_any_more_is_dropped_when_another_one_joins():
    waves = {QUICK: 0.6, NEARLY_QUICK: 0.034, QUICKER: 0.3}
    causes = [
        wave_cause(name, {rate: 1.0}) for name, rate in zip(("quick", "nearly", "new"), waves, strict=True)
    ]
    fitter = fitter_of(measured_arm(wave_effect(waves)), causes)
    first, second, _ = fitter.candidates
    found = search_stepwise(fitter, start=(first, second))
    assert names(found) == [("new", (2,)), ("quick", (2,))]
    assert ("dropped", "nearly") in {(step.action, step.candidate.cause.id) for step in found.steps}


def test_a_member_is_judged_by_its_own_columns_wherever_it_stands():
    causes = (
        made_up("one", lambda state, _: [np.sin(QUICK * state.position[:, 1])]),
        made_up("two", lambda state, _: [wave(QUICKER * state.position[:, 1]) for wave in (np.sin, np.cos)]),
    )
    fitter = fitter_of(measured_arm(wave_effect({QUICK: 0.6, QUICKER: 0.3})), causes)
    one, two = map(candidate, causes)
    both, reverse = fitter.fit((two, one)), fitter.fit((one, two))
    assert bic_gain(fitter.fit((one,)), both, 0) == pytest.approx(
        bic_gain(fitter.fit((one,)), reverse), abs=0.5
    )
    assert bic_gain(fitter.fit((two,)), reverse, 0) == pytest.approx(
        bic_gain(fitter.fit((two,)), both), abs=0.5
    )


def test_what_is_not_admissible_is_dropped_by_the_search_and_among_alternatives():
    """As a size that was possible beside another cause, and is not once that one was given up."""

    def columns(state, scalars):
        return [np.sin(QUICK * state.position[:, 1])]

    cause = made_up("forbidden", columns, allowed=lambda scalars: False)
    fitter = fitter_of(measured_arm(wave_effect({QUICK: 0.6})), (cause,))
    none = nothing_found(fitter)
    forbidden = fitter.fit((candidate(cause),))
    assert not forbidden.admissible
    kept, comparisons = compare_alternatives(SearchState(fitter, none, forbidden))
    assert (names(kept), comparisons) == ([], [])
    assert not passes_exit_test(fitter, none, forbidden, 0)


@pytest.mark.parametrize("keeps_out", [(), ("quicker",)])
def test_what_a_chosen_cause_keeps_out_is_not_added_however_much_it_would_explain(keeps_out, monkeypatch):
    causes = (wave_cause("quick", {QUICK: 1.0}), wave_cause("quicker", {QUICKER: 1.0}))
    monkeypatch.setitem(EXCLUDED_BY, "quick", Masking(keeps_out, ""))
    found = search_stepwise(fitter_of(measured_arm(wave_effect({QUICK: 0.6, QUICKER: 0.2})), causes))
    assert [name for name, _ in names(found)] == ["quick", "quicker"][: 2 - len(keeps_out)]


@pytest.mark.parametrize(
    ("like_noise", "share", "named"),
    [(False, 0.5, True), (True, 0.1, True), (True, 0.5, False)],
    ids=["unlike", "more than noise has", "less than noise has"],
)
def test_what_noise_of_positions_passes_for_is_named_only_if_it_explains_more_than_all_of_it(
    like_noise, share, named
):
    def columns(state, scalars):
        return [np.sin(QUICK * state.position[:, 1])]

    cause = made_up("noisy", columns, like_position_noise=like_noise)
    scene = measured_arm(wave_effect({QUICK: 0.04}))
    noise = np.sqrt([0.9, share, 0.9]) * residual_of(measured_arm(None))
    fitter = fitter_of(replace(scene, dataset=replace(scene.dataset, position_torque=noise)), (cause,))
    none = nothing_found(fitter)
    trial = fitter.fit((candidate(cause),))
    assert 0.1 < likelihood_ratio(none, trial) / len(trial.fit.joints[1].torque) < 0.5
    assert is_significant(fitter, none, trial, kinds=1) == named


@cache
def twins():
    """Offer one wave under two names, and another one; the wave of the twins is there."""
    causes = (
        wave_cause("one", {QUICK: 1.0}),
        wave_cause("other", {QUICK: 1.0}),
        wave_cause("far", {QUICKER: 1.0}),
    )
    fitter = fitter_of(measured_arm(wave_effect({QUICK: 0.6})), causes)
    return search_stepwise(fitter)


def test_of_two_causes_with_the_same_column_one_is_named_and_the_other_given_as_equally_good(monkeypatch):
    known = Imitation("one", "other", "they are the same", "move the joint while its twin rests")
    monkeypatch.setattr(imitation, "IMITATIONS", (*IMITATIONS, known))
    found = twins()
    ((name, site),) = names(found)
    (alternative,) = compare_member(found, 0, refit_member(found, 0)).ambiguous
    assert {name, alternative.cause} == {"one", "other"}
    assert alternative.joints == site
    assert alternative.separating_experiment == "move the joint while its twin rests"
    # Noise is learned from different starts, until it gains less than 0.03 per joint; six would be much.
    assert compare_member(found, 0, refit_member(found, 0)).margin == pytest.approx(0.0, abs=0.3)


def test_an_alternative_that_explains_little_is_not_equally_good():
    found = twins()
    alternatives = compare_member(found, 0, refit_member(found, 0)).ambiguous
    assert "far" not in {alternative.cause for alternative in alternatives}


@pytest.mark.parametrize(
    ("like_noise", "size", "named"),
    [(False, 1.0, False), (True, 0.3, False), (True, 1.0, True)],
    ids=["unlike", "more than noise makes", "less than noise makes"],
)
def test_of_causes_that_noise_of_positions_passes_for_one_refutes_the_other_only_by_more_than_it_makes(
    like_noise, size, named
):
    """The alternative has a part of the effect, and lags behind by half of what all noise is worth."""
    causes = tuple(
        made_up(name, wave_of(*rates), like_position_noise=like_noise)
        for name, rates in {"whole": (QUICK, QUICKER), "part": (QUICK,)}.items()
    )
    scene, harmless = (measured_arm(one) for one in (wave_effect({QUICK: 0.05, QUICKER: 0.05}), None))
    noise = residual_of(harmless)
    fitter = fitter_of(replace(scene, dataset=replace(scene.dataset, position_torque=size * noise)), causes)
    whole, part = (fitter.fit((candidate(one),)) for one in causes)
    none, rows = nothing_found(fitter), len(whole.fit.joints[1].torque)
    assert 0.3**2 < (bic_gain(none, whole) - bic_gain(none, part)) / rows < 0.9
    state = SearchState(fitter, none, whole)
    found = compare_member(state, 0, refit_member(state, 0))
    assert [one.cause for one in found.ambiguous] == ["part"] * named
    assert [one.cause for one in found.refuted] == ["part"] * (not named)


def residual_of(scene):
    fitter = fitter_of(scene, ())
    return residual(fitter, fitter.fit(()))


def wave_of(*rates):
    return lambda state, scalars: [sum(np.sin(rate * state.position[:, 1]) for rate in rates)]


def test_ordinary_noise_is_never_asked_for_where_it_is_learned_already(monkeypatch):
    fitter = fitter_of(measured_arm(both, seed=5), CAUSES)
    monkeypatch.setattr(fitter_module, "noise_absorbs_effect", lambda *_rows_and_fit: True)
    assert fitter.needs_ordinary_noise(nothing_found(fitter))
    other = fitter.with_ordinary_noise()
    assert names(search_stepwise(other)) == [("friction_asymmetric", (2,)), ("spring_compensator", (1,))]
    assert fitter.needs_ordinary_noise(nothing_found(fitter))


def found_with(fitter, *members) -> SearchState:
    """Pretend that a search found some causes."""
    return SearchState(fitter, nothing_found(fitter), fitter.fit(members))


def waves_searched_for(*others):
    quick, quicker = wave_cause("quick", {QUICK: 1.0}), wave_cause("quicker", {QUICKER: 1.0})
    fitter = fitter_of(measured_arm(wave_effect({QUICK: 0.6, QUICKER: 0.3})), (quick, quicker, *others))
    return fitter, quick


def test_under_another_noise_a_search_goes_on_from_what_holds_its_place_to_where_a_new_one_ends():
    fitter, quick = waves_searched_for()
    again = confirm(fitter.with_ordinary_noise(), found_with(fitter, candidate(quick)))
    assert again is not None
    assert [step.action for step in again.steps] == ["kept", "added"]
    assert {frozenset(name for name, _ in came) for came in again.through} == {
        frozenset({"quick"}),
        frozenset({"quick", "quicker"}),
    }
    anew = search_stepwise(fitter.with_ordinary_noise())
    assert names(again) == names(anew) == [("quick", (2,)), ("quicker", (2,))]
    assert abs(likelihood_ratio(anew.chosen, again.chosen)) < 1.0


def test_nothing_is_confirmed_where_one_of_what_was_found_has_to_give_way():
    slow = wave_cause("slow", {SLOW: 1.0})
    fitter, quick = waves_searched_for(slow)
    false = found_with(fitter, candidate(quick), candidate(slow))
    assert confirm(fitter.with_ordinary_noise(), false) is None
    assert confirm(fitter.with_ordinary_noise(), found_with(fitter)) is None


def test_a_cause_on_most_joints_is_one_of_those_that_are_named_at_most(monkeypatch):
    """Friction is seldom of one joint alone, and what else is hidden must not be lost behind it."""
    monkeypatch.setattr(search, "SEARCH", replace(SEARCH, causes=2))
    fitter = fitter_of(measured_arm(uneven_throughout, seed=2), CAUSES)
    found = names(search_stepwise(fitter))
    assert ("spring_compensator", (1,)) in found
    assert [site for name, site in found if name == "friction_asymmetric"] == [(1,), (2,), (3,)]


def test_no_more_causes_are_named_than_are_allowed(monkeypatch):
    monkeypatch.setattr(search, "SEARCH", replace(SEARCH, causes=1))
    fitter = fitter_of(measured_arm(both, seed=2), CAUSES)
    assert len(search_stepwise(fitter).chosen.members) == 1
