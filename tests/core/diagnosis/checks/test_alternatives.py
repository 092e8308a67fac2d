"""Put causes where a search might have left them: what others explain better in their place is given up."""

from functools import cache

import numpy as np
import pytest

from tests.core.diagnosis.made_up import candidate, made_up, nothing_found, on_joint
from tests.core.diagnosis.scenes import fitter_of, measured_arm
from tests.core.diagnosis.waves import wave_cause, wave_effect
from veritorque.core.diagnosis.causes.friction_temperature import FrictionTemperature
from veritorque.core.diagnosis.causes.masking import MASKED_BY, Masking
from veritorque.core.diagnosis.checks.alternatives import Comparison, compare_alternatives
from veritorque.core.diagnosis.checks.between_logs import BetweenLogs
from veritorque.core.diagnosis.checks.findings import finding
from veritorque.core.diagnosis.checks.instruments import Instruments
from veritorque.core.diagnosis.checks.structure_left import StructureLeft
from veritorque.core.diagnosis.search.fitter import HypothesisFitter
from veritorque.core.diagnosis.search.hypothesis import Candidate, Hypothesis
from veritorque.core.diagnosis.search.residuals import residual
from veritorque.core.diagnosis.search.state import SearchState
from veritorque.core.diagnosis.thresholds.checks import CONFIDENCE

QUICK, QUICKER, SLOW = 7.0, 11.0, 4.0
"""Waves per radian: none of them is gravity."""
HELD_OUT_FROM = 16.0
"""When the last fifth of the log begins, s."""
STRONG, WEAK = wave_cause("strong", {QUICK: 1.0}), wave_cause("weak", {QUICKER: 1.0})
STOPGAP = wave_cause("stopgap", {QUICKER: 1.0, SLOW: 0.8})
ENDING = wave_cause("ending", {QUICKER: 1.0, SLOW: 2.0})


@cache
def two_waves() -> tuple[HypothesisFitter, Hypothesis]:
    """Hide a strong and a weak wave; take them for candidates, and something that resembles the weak one."""
    fitter = fitter_of(measured_arm(wave_effect({QUICK: 0.6, QUICKER: 0.2})), (STRONG, WEAK, STOPGAP))
    return fitter, nothing_found(fitter)


def compared(
    start: tuple[HypothesisFitter, Hypothesis], *members: Candidate
) -> tuple[list[str], SearchState, list[Comparison]]:
    """Compare what is put there with its alternatives; give the names that remain, with everything else."""
    fitter, none = start
    selection, comparisons = compare_alternatives(SearchState(fitter, none, fitter.fit(members)))
    return [one.cause.id for one in selection.chosen.members], selection, comparisons


def test_what_was_hidden_is_preferred_to_all_alternatives():
    names, selection, comparisons = compared(two_waves(), candidate(STRONG), candidate(WEAK))
    assert names == ["strong", "weak"]
    assert selection.steps == ()
    assert all(one.margin > 6.0 for one in comparisons)


def test_a_stopgap_beside_a_strong_effect_is_given_up_and_the_step_is_on_record():
    names, selection, comparisons = compared(two_waves(), candidate(STRONG), candidate(STOPGAP))
    assert names == ["strong"]
    assert [(one.action, one.candidate.cause.id) for one in selection.steps] == [("dropped", "stopgap")]
    assert len(comparisons) == 1


@pytest.mark.parametrize(("more", "names"), [(0.02, ["strong", "weak"]), (0.05, ["strong"])])
def test_a_lead_that_columns_of_a_real_robot_may_give_does_not_decide_against_a_finding_either(more, names):
    """Its alternative leads by more than 6 in either case, but by 2 or by 4 % of its likelihood ratio."""
    near = wave_cause("near", {QUICKER: 1.0, SLOW: more})
    hidden = measured_arm(wave_effect({QUICK: 0.6, QUICKER: 0.2, SLOW: 0.2 * more}))
    fitter = fitter_of(hidden, (STRONG, WEAK, near))
    left, _, comparisons = compared((fitter, nothing_found(fitter)), candidate(STRONG), candidate(WEAK))
    assert left == names
    assert all(one.margin < -6.0 for one in comparisons[1:])
    assert [[other.cause for other in one.ambiguous] for one in comparisons[1:]] == [["near"]] * (
        len(names) - 1
    )


@cache
def a_wave_beside_one_that_ends() -> tuple[HypothesisFitter, Hypothesis]:
    """Add to the weak wave what its alternative has besides, but only on the rows that are fitted."""

    def effect(state):
        seen = (state.time < HELD_OUT_FROM)[:, None]
        return wave_effect({QUICK: 0.6, QUICKER: 0.2})(state) + seen * wave_effect({SLOW: 0.4})(state)

    fitter = fitter_of(measured_arm(effect), (STRONG, WEAK, ENDING))
    return fitter, nothing_found(fitter)


def test_an_alternative_that_does_not_hold_on_held_out_rows_refutes_nothing():
    names, _, comparisons = compared(a_wave_beside_one_that_ends(), candidate(STRONG), candidate(WEAK))
    assert names == ["strong", "weak"]
    (ending,) = (one for one in comparisons[1].refuted if one.cause == "ending")
    assert ending.statistic > comparisons[1].statistic + 6.0
    assert "held-out data" in ending.why


def test_what_explains_most_is_not_a_stopgap_however_much_better_others_are():
    """Alone it is a finding with an alternative that explains more, and the report says so."""
    names, _, (comparison,) = compared(two_waves(), candidate(STOPGAP))
    assert names == ["stopgap"]
    assert comparison.margin < -6.0


@pytest.mark.parametrize(
    ("leaves", "alternative"), [((), True), (("push",), False)], ids=["is", "is left, and is not"]
)
def test_an_event_that_a_cause_leaves_where_it_acts_is_no_alternative_to_it(leaves, alternative, monkeypatch):
    def now_and_then(state, _):
        return [np.abs(np.sin(state.position[:, 1])) > 0.9]

    clip, push = made_up("clip", now_and_then), made_up("push", now_and_then, transient=True)
    monkeypatch.setitem(MASKED_BY, "clip", Masking(leaves, ""))
    scene = measured_arm(on_joint(lambda state: 0.5 * now_and_then(state, None)[0]))
    fitter = fitter_of(scene, (clip, push))
    *_, (found,) = compared((fitter, nothing_found(fitter)), candidate(clip))
    assert ["push" for _ in range(alternative)] == [one.cause for one in found.ambiguous]


def product(state):
    return 0.3 * state.velocity[:, 0] * state.velocity[:, 2]


@pytest.mark.parametrize(("spoilt", "kept"), [(0.0, ["alike"]), (0.3, [])], ids=["the same", "half of it"])
def test_a_name_that_a_pattern_without_one_beats_by_far_is_given_up(spoilt, kept):
    def columns(state, scalars):
        return [product(state) + spoilt * np.sin(QUICK * state.position[:, 1])]

    cause = made_up("alike", columns)
    fitter = fitter_of(measured_arm(on_joint(product)), (cause,))
    assert compared((fitter, nothing_found(fitter)), candidate(cause))[0] == kept


def test_a_name_stays_beside_a_pattern_that_explains_more_of_something_else_and_is_doubtful():
    """The pattern leads in its place, and explains hardly anything of it. No other joint confirms it."""

    def small(state):
        return 0.05 * np.sin(QUICK * state.position[:, 1])

    cause = made_up("small", lambda state, _: [small(state)])
    fitter = fitter_of(measured_arm(on_joint(lambda state: product(state) + small(state))), (cause,))
    names, kept, (found,) = compared((fitter, nothing_found(fitter)), candidate(cause))
    assert names == ["small"]
    assert found.over_unnamed < -found.statistic
    assert found.stays_beside_unnamed
    checks = Instruments(fitter, kept.chosen), StructureLeft(fitter, kept.chosen)
    left = residual(fitter, kept.chosen)
    named = finding(kept, found, left, 0.0, checks, BetweenLogs(fitter, kept.chosen))
    assert named.confidence <= CONFIDENCE.doubtful


def blow(state):
    return 1.0 * ((state.time > 6.0) & (state.time < 6.4))


def twice(state):
    """Act when the blow does and later again, on no held-out row: like a cause that a motion hardly shows."""
    return blow(state) + 0.7 * ((state.time > 10.0) & (state.time < 10.4))


@pytest.mark.parametrize(("hidden", "kept"), [(blow, []), (twice, ["lasting"])])
def test_a_lasting_cause_whose_evidence_is_one_event_that_is_no_contact_is_given_up(hidden, kept):
    lasting = made_up("lasting", lambda state, _: [twice(state)])
    event = made_up("event", lambda state, _: [blow(state)], transient=True, allowed=lambda _: False)
    fitter = fitter_of(measured_arm(on_joint(hidden)), (lasting, event))
    assert compared((fitter, nothing_found(fitter)), candidate(lasting))[0] == kept


@pytest.mark.parametrize("change", [0.1, 0.4, 1.6])
def test_friction_that_falls_at_once_is_no_warm_up(change):
    def dragging(state):
        return change * np.sign(state.velocity[:, 1]) * (state.time < 7.3)

    cause = FrictionTemperature()
    fitter = fitter_of(measured_arm(on_joint(dragging)), (cause,))
    none = nothing_found(fitter)
    best = fitter.scan(none)[0].candidate
    assert best.site == (2,)
    assert compared((fitter, none), best)[0] == []
