"""Hold the code to the sizes, docstrings and plain packages that the house rules promise."""

import ast
from pathlib import Path

import numpy as np
import pytest
from jaxtyping import TypeCheckError

ROOT = Path(__file__).parents[2]
MODULES = sorted(path for folder in ("core", "app") for path in (ROOT / folder).rglob("*.py"))
CORE = [path for path in MODULES if path.is_relative_to(ROOT / "core")]
PACKAGES = [
    *(path for path in MODULES if path.name == "__init__.py" and path != ROOT / "core" / "__init__.py"),
    *sorted((ROOT / "tests").rglob("__init__.py")),
]
LONGEST_FILE = 300


def label(path: Path) -> str:
    return str(path.relative_to(ROOT))


def tree(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


def public_definitions(module: ast.Module) -> list[ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef]:
    kinds = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
    return [node for node in module.body if isinstance(node, kinds) and not node.name.startswith("_")]


def is_sentence(docstring: str | None) -> bool:
    """Judge the first paragraph: a capital letter or a symbol first, at least three words, a full stop."""
    summary = " ".join((docstring or "").strip().split("\n\n")[0].split())
    return len(summary.split()) >= 3 and summary.endswith(".") and not summary[0].islower()


@pytest.mark.parametrize("path", MODULES, ids=label)
def test_a_file_holds_one_idea_in_at_most_300_lines(path):
    assert len(path.read_text(encoding="utf-8").splitlines()) <= LONGEST_FILE


@pytest.mark.parametrize("path", PACKAGES, ids=label)
def test_a_package_says_what_comes_in_and_goes_out_and_does_nothing_else(path):
    body = tree(path).body
    assert len(body) == 1
    assert ast.get_docstring(tree(path))


@pytest.mark.parametrize("path", MODULES, ids=label)
def test_every_folder_with_code_is_a_package(path):
    assert (path.parent / "__init__.py").exists()


@pytest.mark.parametrize("path", MODULES, ids=label)
def test_a_module_opens_with_what_it_is_and_why(path):
    assert is_sentence(ast.get_docstring(tree(path)))


@pytest.mark.parametrize("path", CORE, ids=label)
def test_every_public_name_of_core_is_explained_by_a_full_sentence(path):
    silent = [
        node.name for node in public_definitions(tree(path)) if not is_sentence(ast.get_docstring(node))
    ]
    assert silent == []


@pytest.mark.parametrize("path", CORE, ids=label)
def test_annotations_of_core_are_values_so_that_shapes_can_be_checked(path):
    futures = [
        node
        for node in ast.walk(tree(path))
        if isinstance(node, ast.ImportFrom) and node.module == "__future__"
    ]
    assert futures == []


@pytest.mark.parametrize("docstring", [None, "", "Too short.", "no capital letter first.", "It never ends"])
def test_a_fragment_is_not_a_sentence(docstring):
    assert not is_sentence(docstring)


def test_shapes_are_checked_while_tests_run():
    from veritorque.core.robot.inertia import pseudo_inertia

    with pytest.raises(TypeCheckError):
        pseudo_inertia(np.zeros(9))
