"""Keep the reader's list of causes the one that the causes write of themselves."""

from pathlib import Path

from veritorque.core.diagnosis.causes.guide import CURES, guide
from veritorque.core.diagnosis.causes.imitation import imitations
from veritorque.core.diagnosis.causes.registry import BY_ID

PAGE = Path(__file__).parents[2] / "docs" / "causes.md"


def test_the_committed_page_is_what_the_causes_say_of_themselves():
    assert PAGE.read_text(encoding="utf-8") == guide(), "run `make reference` and review the change"


def test_every_cause_has_a_section_with_its_numbers_and_every_link_leads_to_one():
    sections = {part.split("\n", 1)[0]: part for part in guide().split("\n## ")[2:]}
    assert list(sections) == list(BY_ID)
    for name, one in BY_ID.items():
        assert all(f"| {number} |" in sections[name] for number, _ in one.units)
        assert all(f"(#{other})" in sections[name] for other in imitations(name))


def test_every_cure_is_explained():
    assert {one.cure for one in BY_ID.values()} <= set(CURES)
