"""One cause of the whole robot takes the place of several found joint by joint where it explains better."""

from dataclasses import replace

import pytest

from tests.core.diagnosis.made_up import nothing_found
from tests.core.diagnosis.scenes import bench_of, measured_arm
from tests.core.diagnosis.waves import BuiltOn, WaveCause, wave_cause, wave_effect
from veritorque.core.diagnosis.checks.alternatives import INDIFFERENCE
from veritorque.core.diagnosis.search.restarts import consolidated, criterion, reconsidered
from veritorque.core.diagnosis.search.stepwise import Selection, select

PARTS = ("first", "second", "third")
RATES = (7.0, 11.0, 4.0)
SIZES = (0.6, 0.3, 0.4)


def found_one_by_one(sizes=SIZES, *, leaves=PARTS, excludes=(), first=PARTS, further=()):
    """Give a bench, and what a search has found on it: the causes of these names."""
    parts = [wave_cause(name, {rate: 1.0}) for name, rate in zip(PARTS, RATES, strict=True)]
    whole = wave_cause("whole", dict(zip(RATES, SIZES, strict=True)))
    type(whole).leaves, type(whole).excludes = leaves, excludes
    type(whole).sites = lambda *_: [()]
    type(whole).term = lambda self, look, believed, _, scalars: super(type(whole), self).term(
        look, believed, (2,), scalars
    )
    bench = bench_of(
        measured_arm(wave_effect(dict(zip((*RATES, 15.0), sizes, strict=False)))), [*parts, whole, *further]
    )
    none = nothing_found(bench)
    members = tuple(one for name in first for one in bench.candidates if one.cause.id == name)
    return bench, Selection(none, bench.tried(members), ())


def named(selection):
    return [one.cause.id for one in selection.chosen.members]


def test_what_one_cause_explains_with_fewer_numbers_is_that_cause():
    bench, found = found_one_by_one()
    better = consolidated(bench, found)
    assert named(better) == ["whole"]
    assert criterion(better.chosen) > criterion(found.chosen) + INDIFFERENCE
    assert [(step.action, step.candidate.cause.id) for step in better.steps] == [("swapped", "whole")]


@pytest.mark.parametrize(
    "case",
    [{"sizes": (0.6, 0.6, 0.6)}, {"leaves": PARTS[:1]}, {"first": PARTS[1:2]}],
    ids=["it explains less", "it leaves but one of them", "there are not several"],
)
def test_otherwise_what_was_found_stays(case):
    bench, found = found_one_by_one(**case)
    believed = bench.believed
    assert consolidated(bench, found) is found
    assert bench.believed is believed


def test_a_search_that_begins_with_the_whole_goes_on_from_there():
    bench, found = found_one_by_one((*SIZES, 0.4), further=[wave_cause("quickest", {15.0: 1.0})])
    better = consolidated(bench, found)
    assert named(better) == ["whole", "quickest"]


def test_a_search_that_comes_to_where_the_first_one_went_on_from_ends_there():
    bench, found = found_one_by_one((*SIZES, 0.4), further=[wave_cause("quickest", {15.0: 1.0})])
    end = frozenset(consolidated(bench, found).chosen.by_key)
    found = replace(found, through=frozenset({end}))
    assert consolidated(bench, found) is found


def test_a_search_that_stays_where_it_began_has_met_no_other():
    bench, found = found_one_by_one()
    better = consolidated(bench, found)
    found = replace(found, through=frozenset({frozenset(better.chosen.by_key)}))
    assert named(consolidated(bench, found)) == ["whole"]


def test_a_search_tells_what_sets_of_causes_it_came_through():
    waves = (("quick", 7.0, 0.6), ("slow", 4.0, 0.3))
    bench = bench_of(
        measured_arm(wave_effect({rate: size for _, rate, size in waves})),
        [wave_cause(name, {rate: 1.0}) for name, rate, _ in waves],
    )
    quick, slow = (one.key for one in select(bench).chosen.members)
    assert select(bench).through == {frozenset({quick}), frozenset({quick, slow})}


def test_what_the_whole_cannot_stand_beside_goes_with_what_it_leaves():
    bench, found = found_one_by_one(leaves=PARTS[:2], excludes=PARTS[2:])
    better = consolidated(bench, found)
    assert named(better) == ["whole"]


class Flattering(WaveCause):
    """Suspect one wave, which looks like three until it is believed in the size of that one."""

    id = title = "flattering"

    def term(self, look, believed, site, scalars):
        sizes = [float(value[0]) for one, value in believed.joined if isinstance(one, BuiltOn)]
        half = 1.0 if sizes else 0.5
        alone = any(size < 1.5 for size in sizes)
        waves = {7.0: 0.6} if alone else {7.0: 0.6 * half, 4.5: 0.3 * half, 11.0: 0.03 * half}
        return BuiltOn(site[0], waves, believed)


def test_what_explains_less_once_it_is_believed_makes_way_for_what_it_hid():
    effect = wave_effect({7.0: 0.6, 4.5: 0.3})
    bench = bench_of(measured_arm(effect), (Flattering(), wave_cause("slow", {4.5: 1.0})))
    found = select(bench)
    assert named(found) == ["flattering"]
    assert named(reconsidered(bench, found)) == ["flattering", "slow"]


def test_where_nothing_was_hid_what_was_found_and_believed_stays():
    bench = bench_of(measured_arm(wave_effect({7.0: 0.6, 4.5: 0.3})), (Flattering(),))
    found, believed = select(bench), bench.believed
    assert reconsidered(bench, found) is found
    assert bench.believed is believed
