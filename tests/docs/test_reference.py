"""The generated pages are what the code says, and every link and anchor of every document leads somewhere."""

import json
import re
from pathlib import Path

import pytest

from tests.core.dynamics.every_term import cures
from tests.docs.blocks import PAGES, ROOT
from veritorque.app.problems import KINDS
from veritorque.app.reference import api, problems
from veritorque.core.dynamics import guide as terms
from veritorque.core.dynamics.model import STANDARD_TERMS
from veritorque.core.export import guide as formats
from veritorque.core.export.formats import FORMATS
from veritorque.core.log.columns.profiles import PROFILES
from veritorque.core.log.formats.content import FORMS

CONTRACT = json.loads((ROOT / "openapi.json").read_text(encoding="utf-8"))
GENERATED = {
    "api": lambda: api.guide(CONTRACT),
    "problems": problems.guide,
    "terms": terms.guide,
    "formats": formats.guide,
}
_FENCED = re.compile(r"^```.*?^```$", re.DOTALL | re.MULTILINE)
_LINK = re.compile(r"\]\(([^)\s]+)\)")


@pytest.mark.parametrize("name", GENERATED)
def test_a_generated_page_is_what_the_code_says(name):
    written = (ROOT / "docs" / f"{name}.md").read_text(encoding="utf-8")
    assert written == GENERATED[name](), "run `make reference` and review the change"


def test_the_reference_names_every_request_and_every_document():
    page = GENERATED["api"]()
    asked = [(method, path) for path, methods in CONTRACT["paths"].items() for method in methods]
    assert all(f"\n### {method.upper()} {path}\n" in page for method, path in asked)
    documents = [name for name, one in CONTRACT["components"]["schemas"].items() if one.get("properties")]
    assert all(f"\n### {name}\n" in page for name in documents)


def test_the_reference_names_every_term_with_its_parameters():
    page = GENERATED["terms"]()
    assert all(f"\n### {name}\n" in page for name in STANDARD_TERMS)
    for term in cures():
        kind = getattr(term, "kind", "joint_coupling")  # which is the standard model's term on other joints
        assert kind == "joint_coupling" or f"(causes.md#{kind})" in page


def test_the_reference_names_every_problem_format_unit_and_recorder():
    assert all(f"| `{kind}` |" in GENERATED["problems"]() for kind in KINDS)
    page = GENERATED["formats"]()
    assert all(f"| {form.name} |" in page for form in FORMS)
    assert all(f"| `{name}` |" in page for name in (*PROFILES, *FORMATS))


def anchors(path: Path) -> set[str]:
    """Give the anchors that GitHub and the site make of a page's headings."""
    headings = re.findall(r"^#+ (.+)$", _FENCED.sub("", path.read_text(encoding="utf-8")), re.MULTILINE)
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}


def broken(page: Path) -> list[str]:
    """List the links of a page inside the project that lead nowhere."""
    found = []
    for target in _LINK.findall(_FENCED.sub("", page.read_text(encoding="utf-8"))):
        name, _, anchor = target.partition("#")
        file = (page.parent / name).resolve() if name else page
        if "://" not in target and not (file.exists() and (not anchor or anchor in anchors(file))):
            found.append(target)
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_link_of_a_document_leads_somewhere(page):
    assert broken(page) == []


def test_a_link_that_leads_nowhere_is_noticed(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("# One\n[a](#one) [b](#two) [c](other.md) [d](page.md#one) [e](page.md#three)\n")
    assert broken(page) == ["#two", "other.md", "page.md#three"]


def test_documents_that_the_code_names_exist():
    named = {
        (path, name)
        for folder in ("app", "core")
        for path in (ROOT / folder).rglob("*.py")
        for name in re.findall(r"\bdocs/[\w-]+\.md\b", path.read_text(encoding="utf-8"))
    }
    assert named
    assert [(str(path), name) for path, name in named if not (ROOT / name).exists()] == []


def test_fifteen_questions_are_asked_and_each_answer_is_short_and_leads_on():
    text = (ROOT / "docs" / "questions.md").read_text(encoding="utf-8")
    answers = text.split("\n## ")[1:]
    assert len(answers) == 15
    for answer in answers:
        assert len(answer.split()) < 110, answer
        assert _LINK.search(answer), answer
