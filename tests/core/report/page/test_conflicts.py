"""What robot and logs disagree in stands before every result, with the correction to paste."""

import json
from html import unescape

import pytest

from tests.core.report.documents import conflict, diagnosed, identified
from veritorque.core.report.page.conflicts import disagreements, other_warnings
from veritorque.core.report.page.page import compose_page

DOUBTS = {"doubts": ["Robot and log disagree: as the conflict says", "The motion does not excite MX2"]}


@pytest.mark.parametrize("document", [identified(), diagnosed()], ids=["identify", "diagnose"])
def test_conflicts_and_warnings_stand_before_the_headline_of_both_kinds(document):
    page = unescape(compose_page(document | DOUBTS | {"conflicts": [conflict()]}))
    begin = page.index("<header>")
    order = [
        "Robot and log disagree: exchange the channels of joints 1 and 2, error 47.1 → 4.83 %",
        "position sign of joint 2 (it predicts as well)",
        '"columns": ["tau_2", "tau_1"]',
        "The motion does not excite MX2",
        '<h1 class="verdict">',
    ]
    places = [page.index(words, begin) for words in order]
    assert places == sorted(places)
    assert page.count("The motion does not excite MX2") == 1
    assert "as the conflict says" not in page  # its own words say more


def test_conflicts_of_one_correction_are_one_and_what_is_pasted_is_the_correction():
    both = [conflict(), conflict(conflict="mounting", joints=[], channel=None)]
    stamps = conflict(
        conflict="time_base",
        error_before_percent=None,
        error_after_percent=None,
        applied=False,
        correction={"mapping": {"time": None, "rate_hz": 100.0}, "robot": {}},
        ambiguous_with=[],
    )
    first, second = disagreements({"conflicts": [*both, stamps]})
    assert len(first.conflicts) == 2
    assert json.loads(first.correction) == {"mapping": {"torque": {"columns": ["tau_2", "tau_1"]}}}
    assert json.loads(second.correction) == {"mapping": {"time": None, "rate_hz": 100.0}}
    assert first.applied != second.applied
    heading, sentences = second.conflicts[0]
    assert "error" not in heading
    assert len(sentences) == 1


def test_a_document_without_conflicts_shows_all_its_warnings():
    assert disagreements(identified()) == []
    assert other_warnings(identified(**DOUBTS)) == DOUBTS["doubts"]
