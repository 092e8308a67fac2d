"""Keep the documents true: the API document, the commands a reader types, the versions, the reasons."""

import json
import re
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
DOCUMENTS = [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "docker/README.md")]


def make_commands(text: str) -> set[str]:
    """Find the targets in `make target`, in code spans and fenced blocks only."""
    code = "\n".join([*re.findall(r"```.*?```", text, re.DOTALL), *re.findall(r"`[^`\n]+`", text)])
    return set(re.findall(r"(?<![\w-])make ([a-z][\w-]*)", code))


def make_targets() -> set[str]:
    return set(re.findall(r"^([a-z][\w-]*):", (ROOT / "Makefile").read_text(), re.MULTILINE))


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_every_make_command_a_reader_is_told_to_type_exists(document):
    assert make_commands(document.read_text()) <= make_targets()


def test_the_readme_tells_how_to_see_it_run_and_how_to_test_it():
    assert {"demo", "serve", "test"} <= make_commands((ROOT / "README.md").read_text())


def test_words_outside_code_are_not_commands():
    assert make_commands("make sure to run `make test`\n```\nmake demo\n```") == {"test", "demo"}


def test_the_committed_api_document_is_the_one_the_service_gives(monkeypatch, tmp_path):
    from veritorque.app.main import create_app

    monkeypatch.setenv("VERITORQUE_DATA_DIR", str(tmp_path))
    given = json.dumps(create_app().openapi(), indent=2, sort_keys=False) + "\n"
    assert (ROOT / "openapi.json").read_text() == given, "run `make openapi` and review the change"


def test_every_dependency_has_its_reason_in_the_decisions():
    headings = set(re.findall(r"^### ([\w.-]+)", (ROOT / "docs" / "decisions.md").read_text(), re.MULTILINE))
    extras = PROJECT["optional-dependencies"]
    declared = (*PROJECT["dependencies"], *extras["postgres"], *extras["ros"])
    names = {re.match(r"[\w.-]+", requirement).group() for requirement in declared}
    assert names <= headings


def test_the_version_is_the_same_wherever_it_is_written():
    citation = re.search(r"^version: (\S+)$", (ROOT / "CITATION.cff").read_text(), re.MULTILINE)
    newest = re.search(r"^## \[(\d\S*)\]", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)
    assert (citation.group(1), newest.group(1)) == (PROJECT["version"], PROJECT["version"])
