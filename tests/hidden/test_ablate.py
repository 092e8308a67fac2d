import pytest

from tests.hidden.ablate import Answers, Task, answers, changed_value, line, thresholds

PLAIN = [("nothing_found",), ("causes_found", "backlash [2]")]


def of(*answered):
    return Answers(Task("ENTRY.level", 0.5, ()), list(answered), 1.0)


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
        ("SEARCH.several", 1, 0.5, 1),
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
        answers(Task("ENTRY.level", 0.5, ()))
