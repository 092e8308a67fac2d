"""What silences a check, or leaves a test out, says why on its own line; nothing is expected to fail."""

import ast
import re
from itertools import pairwise
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FOLDERS = ("core", "app", "tests", "benchmarks", "examples", "docker")
MODULES = [ROOT / "conftest.py", *sorted(path for name in FOLDERS for path in (ROOT / name).rglob("*.py"))]
DIRECTIVE = re.compile(
    r"#\s*(?:ruff:\s*)?"
    r"(?:noqa\b(?::[A-Z0-9, ]+)?|type: ignore\b(?:\[[^\]]*\])?|fmt: skip|pragma: no cover)"
)
A_WORD = re.compile(r"[a-z]{3}")


def without_reason(line: str) -> bool:
    """Tell whether a line silences a check, and says nothing else behind."""
    found = DIRECTIVE.split(line)
    return len(found) > 1 and not any(map(A_WORD.search, found[1:]))


def left_out(module: ast.Module) -> list[ast.Call]:
    """Give the calls that leave tests out, without a reason."""
    calls = [node for node in ast.walk(module) if isinstance(node, ast.Call)]
    return [call for call in calls if _leaves_out(call) and not _says_why(call)]


def _leaves_out(call: ast.Call) -> bool:
    name = ast.unparse(call.func)
    return name in {"pytest.skip", "pytest.importorskip"} or name.startswith(
        ("pytest.mark.skip", "pytest.mark.xfail")
    )


def _says_why(call: ast.Call) -> bool:
    said = call.args[:1] if ast.unparse(call.func) == "pytest.skip" else []
    return bool(said) or any(word.arg == "reason" for word in call.keywords)


@pytest.mark.parametrize(
    ("line", "bare"),
    [
        ("x = 1  # noqa: F401", True),
        ("x = 1  # type: ignore[attr-defined]  # noqa: SLF001", True),
        ("}  # fmt: skip", True),
        ("def f():  # pragma: no cover", True),
        ("def f():  # pragma: no cover  (compiled)", False),
        ("x = 1  # noqa: F401  (a fixture of both)", False),
        ("x = 1  # type: ignore[attr-defined]  # noqa: SLF001  # it has no public name", False),
        ("x = 1  # a comment", False),
    ],
)
def test_a_line_that_silences_a_check_without_a_reason_is_found(line, bare):
    assert without_reason(line) is bare


def test_every_check_that_is_silenced_says_why():
    bare = [
        f"{path}:{number}"
        for path in MODULES
        if path != Path(__file__)
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
        if without_reason(line)
    ]
    assert bare == []


def test_what_a_whole_module_is_spared_by_mypy_is_explained_on_the_line_above():
    for path in MODULES:
        lines = path.read_text(encoding="utf-8").splitlines()
        for above, line in pairwise(lines):
            if line.startswith("# mypy:"):
                assert re.match(r"# [A-Z].*[a-z]{3}", above), path


def test_every_test_that_is_left_out_says_why_and_none_is_expected_to_fail():
    texts = {path: path.read_text(encoding="utf-8") for path in MODULES if path != Path(__file__)}
    named = {path: text for path, text in texts.items() if "skip" in text or "xfail" in text}
    assert [str(path) for path, text in named.items() if left_out(ast.parse(text))] == []
    assert [str(path) for path, text in texts.items() if "xfail(" in text] == []
