import numpy as np
import pytest

from tests.hidden.ablate import Answers, Task, answers, changed_value, label, line, thresholds
from tests.hidden.group_test import group_test
from tests.hidden.plan import Order, quick
from tests.plant.effects.registry import EFFECTS

PLAIN = [("nothing_found",), ("causes_found", "backlash [2]")]


def of(*answered):
    return Answers(Task(("ENTRY.level",), 0.5, ()), list(answered), 1.0)


def test_every_threshold_can_be_changed_and_stays_of_its_kind():
    for name, (group, field) in thresholds().items():
        value = getattr(group, field)
        halved, doubled = (changed_value(name, value, factor) for factor in (0.5, 2.0))
        assert type(halved) is type(doubled) is type(value)
        assert halved != doubled


@pytest.mark.parametrize(
    ("name", "value", "factor", "changed"),
    [
        ("ENTRY.level", 1e-4, 2.0, 2e-4),
        ("SEARCH.causes", 1, 0.5, 1),
        ("ROWS.spike_order", 5, 2.0, 11),
        ("PREDICTION.quantile", 0.975, 2.0, 0.95),
    ],
)
def test_a_threshold_is_halved_or_doubled_where_that_makes_sense(name, value, factor, changed):
    assert changed_value(name, value, factor) == pytest.approx(changed)


def test_changed_answers_are_counted_and_thresholds_without_any_are_flagged():
    other = ("causes_found", "backlash [3]")
    assert line(PLAIN, of(PLAIN[0], other), of(*PLAIN)).split() == ["ENTRY.level", "1", "0"]
    assert line(PLAIN, of(*PLAIN), of(*PLAIN)).endswith("changes none")
    assert line(PLAIN, of(PLAIN[0], ("failed: no rows",)), of(*PLAIN)).endswith("!")


def test_a_threshold_is_not_changed_where_the_diagnosis_was_loaded_before():
    import veritorque.core.diagnosis.diagnose  # noqa: F401  # loading it is what the test is about

    with pytest.raises(RuntimeError, match="loaded before"):
        answers(Task(("ENTRY.level",), 0.5, ()))


@pytest.mark.parametrize("seed", range(3))
def test_group_tests_find_every_threshold_that_changes_an_answer_and_few_cases_are_run(seed):
    rng = np.random.default_rng(seed)
    names, cases, run = [f"threshold {number}" for number in range(180)], 40, []
    telling = {name: set(rng.integers(cases, size=4)) for name in rng.choice(names, 60, replace=False)}

    def first(some, chosen):
        for case in chosen:
            run.append(case)
            if any(case in telling.get(name, ()) for name in some):
                return case
        return None

    found = list(group_test(names, cases, first))
    assert {name for some in found[:-1] for name in some.names} == telling.keys()
    assert all(some.case in telling[name] for some in found[:-1] for name in some.names)
    assert (set(found[-1].names), found[-1].case) == (set(names) - telling.keys(), None)
    assert len(run) < len(names) * cases / 5


def test_thresholds_that_change_an_answer_only_together_are_settled_in_two_sets():
    def first(some, chosen):
        return 7 if 7 in chosen and {"a", "d"} <= set(some) else None

    assert list(group_test("abcde", 9, first)) == [(("d",), None), (("a", "b", "c", "e"), None)]


def test_what_another_threshold_hides_is_found_when_that_one_is_out():
    def first(some, chosen):
        shown = {5} if "stops all" in some else {2} if "hidden" in some else set()
        return min(shown & set(chosen), default=None)

    assert list(group_test(["stops all", "hidden"], 9, first)) == [(("stops all",), 5), (("hidden",), 2)]


def test_a_quick_run_has_every_cause_and_logs_without_any():
    listed = quick(1)
    assert {order.cause for order in listed if order.kind == "single"} == EFFECTS.keys()
    assert {order.kind for order in listed} == {"single", "combination", "clean", "foreign"}
    assert len({order.seed for order in listed}) == len(listed)


def test_a_case_is_named_as_a_table_shows_it():
    assert label(Order("single", 7, "backlash", robot="planar-2")) == "planar-2 single backlash 7"
