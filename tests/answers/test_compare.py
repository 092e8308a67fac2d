"""The comparison of answers: what a program would notice is distinguished from what only a reader would."""

import copy

import pytest

from tests.answers.compare import compare
from tests.answers.kept import keep, kept, names

DOCUMENT = {
    "kind": "diagnose",
    "provenance": {"version": "0.1.0", "log_sha256": [""]},
    "value": 0.1234567891,
    "rows": [{"name": "M1", "unit": "N m", "value": 2.0}, {"name": "M2", "unit": "kg", "value": None}],
    "doubts": ["The mass of link 1 is a guess"],
    "findings": [{"cause": "backlash", "title": "Play in the gear", "joints": [1, 2], "held_out": True}],
}


def changed(change):
    other = copy.deepcopy(DOCUMENT)
    change(other)
    return compare(DOCUMENT, other)


def only(change):
    (one,) = changed(change).differences
    return one


def test_a_document_equals_itself_and_its_leaves_are_counted():
    found = changed(lambda _document: None)
    assert found.differences == ()
    assert (found.numbers, found.strings) == (6, 10)


def test_a_changed_last_digit_is_a_difference_of_known_size():
    one = only(lambda document: document.update(value=0.1234567892))
    assert (one.what, one.path, one.fails) == ("value", "value", True)
    assert one.relative == pytest.approx(8.1e-10, rel=0.01)
    assert one.ulps == pytest.approx(7.2e6, rel=0.01)


def test_the_very_last_bit_is_a_difference():
    one = only(lambda document: document["rows"][0].update(value=2.0000000000000004))
    assert (one.path, one.group, one.ulps) == ("rows[0].value", "rows[].value", 1.0)


@pytest.mark.parametrize("value", [2, True, "2.0", None, [2.0], {"value": 2.0}])
def test_another_type_is_a_difference_although_python_may_call_it_equal(value):
    assert only(lambda document: document["rows"][0].update(value=value)).fails


def test_the_sign_of_zero_is_a_difference():
    assert compare({"a": 0.0}, {"a": -0.0}).failures


def test_a_flag_that_turns_is_a_difference():
    assert only(lambda document: document["findings"][0].update(held_out=False)).what == "value"


def test_a_missing_field_is_a_difference():
    one = only(lambda document: document["rows"][1].pop("value"))
    assert (one.what, one.path, one.fails) == ("missing", "rows[1].value", True)


def test_an_extra_field_is_a_difference():
    one = only(lambda document: document["findings"][0].update(gain=None))
    assert (one.what, one.path, one.fails) == ("extra", "findings[0].gain", True)


def test_a_list_of_another_length_is_a_difference():
    one = only(lambda document: document["findings"][0].update(joints=[1]))
    assert (one.what, one.before, one.now, one.fails) == ("length", 2, 1, True)


@pytest.mark.parametrize(
    ("place", "word"), [("doubts", "The mass of link 1 is assumed"), ("title", "A loose gear")]
)
def test_a_changed_word_is_told_and_is_no_failure(place, word):
    def reword(document):
        if place == "doubts":
            document["doubts"][0] = word
        else:
            document["findings"][0]["title"] = word

    found = changed(reword)
    (one,) = found.texts
    assert (found.failures, one.now) == ((), word)
    assert one.group == {"doubts": "doubts[]", "title": "findings[].title"}[place]


def test_a_text_that_goes_away_is_a_difference():
    assert only(lambda document: document["findings"][0].update(title="")).fails


@pytest.mark.parametrize(("key", "name"), [("name", "M3"), ("unit", "kg m")])
def test_a_changed_name_is_a_difference_with_or_without_a_space(key, name):
    assert only(lambda document: document["rows"][0].update({key: name})).fails


def test_the_version_of_the_package_and_the_order_of_keys_are_no_part_of_an_answer():
    other = dict(reversed(DOCUMENT.items())) | {"provenance": DOCUMENT["provenance"] | {"version": "9"}}
    assert compare(DOCUMENT, other).differences == ()


def test_a_kept_answer_comes_back_to_the_last_bit(tmp_path):
    document = {"value": 0.1 + 0.2, "small": 5e-324, "text": "± 1"}
    keep(tmp_path / "new", "one", document)
    assert compare(document, kept(tmp_path / "new", "one")).differences == ()
    assert names(tmp_path / "new") == ["one"]
    assert kept(tmp_path / "new", "two") is None
