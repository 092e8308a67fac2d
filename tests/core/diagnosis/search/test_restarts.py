"""One cause of the whole robot takes the place of several found joint by joint where it explains better."""

from dataclasses import replace

import pytest

from tests.core.diagnosis.made_up import nothing_found
from tests.core.diagnosis.scenes import fitter_of, measured_arm
from tests.core.diagnosis.waves import BuiltOn, WaveCause, wave_cause, wave_effect
from veritorque.core.diagnosis.causes.masking import EXCLUDED_BY, MASKED_BY, Masking
from veritorque.core.diagnosis.search.restarts import (
    bic,
    restart_at_operating_point,
    restart_from_common_cause,
)
from veritorque.core.diagnosis.search.state import SearchState
from veritorque.core.diagnosis.search.stepwise import search_stepwise
from veritorque.core.diagnosis.thresholds.search import SELECTION

PARTS = ("first", "second", "third")
RATES = (7.0, 11.0, 4.0)
SIZES = (0.6, 0.3, 0.4)


@pytest.fixture(autouse=True)
def _tables_as_before(monkeypatch):
    monkeypatch.setitem(MASKED_BY, "whole", Masking((), ""))
    monkeypatch.setitem(EXCLUDED_BY, "whole", Masking((), ""))


def found_one_by_one(sizes=SIZES, *, leaves=PARTS, excludes=(), first=PARTS, further=()):
    """Give what a search has found: the causes of these names."""
    parts = [wave_cause(name, {rate: 1.0}) for name, rate in zip(PARTS, RATES, strict=True)]
    whole = wave_cause("whole", dict(zip(RATES, SIZES, strict=True)))
    MASKED_BY["whole"], EXCLUDED_BY["whole"] = Masking(leaves, ""), Masking(excludes, "")
    type(whole).sites = lambda *_: [()]
    type(whole).term = lambda self, at: super(type(whole), self).term(replace(at, site=(2,)))
    fitter = fitter_of(
        measured_arm(wave_effect(dict(zip((*RATES, 15.0), sizes, strict=False)))), [*parts, whole, *further]
    )
    none = nothing_found(fitter)
    members = tuple(one for name in first for one in fitter.candidates if one.cause.id == name)
    return SearchState(fitter, none, fitter.fit(members))


def named(selection):
    return [one.cause.id for one in selection.chosen.members]


def test_what_one_cause_explains_with_fewer_numbers_is_that_cause():
    found = found_one_by_one()
    better = restart_from_common_cause(found)
    assert named(better) == ["whole"]
    assert bic(better.chosen) > bic(found.chosen) + SELECTION.undecided
    assert [(step.action, step.candidate.cause.id) for step in better.steps] == [("swapped", "whole")]


@pytest.mark.parametrize(
    "case",
    [{"sizes": (0.6, 0.6, 0.6)}, {"leaves": PARTS[:1]}, {"first": PARTS[1:2]}],
    ids=["it explains less", "it leaves but one of them", "there are not several"],
)
def test_otherwise_what_was_found_stays(case):
    found = found_one_by_one(**case)
    assert restart_from_common_cause(found) is found


def test_a_search_that_begins_with_the_whole_goes_on_from_there():
    found = found_one_by_one((*SIZES, 0.4), further=[wave_cause("quickest", {15.0: 1.0})])
    better = restart_from_common_cause(found)
    assert named(better) == ["whole", "quickest"]


def test_a_search_that_comes_to_where_the_first_one_went_on_from_ends_there():
    found = found_one_by_one((*SIZES, 0.4), further=[wave_cause("quickest", {15.0: 1.0})])
    end = frozenset(restart_from_common_cause(found).chosen.by_key)
    found = replace(found, through=frozenset({end}))
    assert restart_from_common_cause(found) is found


def test_a_search_that_stays_where_it_began_has_met_no_other():
    found = found_one_by_one()
    better = restart_from_common_cause(found)
    found = replace(found, through=frozenset({frozenset(better.chosen.by_key)}))
    assert named(restart_from_common_cause(found)) == ["whole"]


def test_a_search_tells_what_sets_of_causes_it_came_through():
    waves = (("quick", 7.0, 0.6), ("slow", 4.0, 0.3))
    fitter = fitter_of(
        measured_arm(wave_effect({rate: size for _, rate, size in waves})),
        [wave_cause(name, {rate: 1.0}) for name, rate, _ in waves],
    )
    quick, slow = (one.key for one in search_stepwise(fitter).chosen.members)
    assert search_stepwise(fitter).through == {frozenset({quick}), frozenset({quick, slow})}


def test_what_the_whole_cannot_stand_beside_goes_with_what_it_leaves():
    found = found_one_by_one(leaves=PARTS[:2], excludes=PARTS[2:])
    better = restart_from_common_cause(found)
    assert named(better) == ["whole"]


class Flattering(WaveCause):
    """Take one wave for a candidate, which resembles three until the model is linearised at its size."""

    id = title = "flattering"

    def term(self, at):
        sizes = [float(value[0]) for one, value in at.operating_point.joined if isinstance(one, BuiltOn)]
        half = 1.0 if sizes else 0.5
        alone = any(size < 1.5 for size in sizes)
        waves = {7.0: 0.6} if alone else {7.0: 0.6 * half, 4.5: 0.3 * half, 11.0: 0.03 * half}
        return BuiltOn(at.joint, waves, at.operating_point)


def test_what_explains_less_at_its_own_operating_point_makes_way_for_what_it_masked():
    effect = wave_effect({7.0: 0.6, 4.5: 0.3})
    fitter = fitter_of(measured_arm(effect), (Flattering(), wave_cause("slow", {4.5: 1.0})))
    found = search_stepwise(fitter)
    assert named(found) == ["flattering"]
    assert named(restart_at_operating_point(found)) == ["flattering", "slow"]


def test_where_nothing_was_masked_hypothesis_and_operating_point_stay():
    fitter = fitter_of(measured_arm(wave_effect({7.0: 0.6, 4.5: 0.3})), (Flattering(),))
    found = search_stepwise(fitter)
    assert restart_at_operating_point(found) is found
