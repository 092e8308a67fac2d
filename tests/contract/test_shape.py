"""Hold the code to the sizes, docstrings and plain packages that the house rules promise."""

import ast
from functools import cache
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
MOST_BRANCHES = 8
BRANCHES = (
    ast.If,
    ast.IfExp,
    ast.For,
    ast.AsyncFor,
    ast.While,
    ast.ExceptHandler,
    ast.Assert,
    ast.match_case,
    ast.comprehension,
)


def label(path: Path) -> str:
    return str(path.relative_to(ROOT))


@cache
def tree(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


def public_definitions(module: ast.Module) -> list[ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef]:
    kinds = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
    return [node for node in module.body if isinstance(node, kinds) and not node.name.startswith("_")]


def is_sentence(docstring: str | None) -> bool:
    """Judge the first paragraph: a capital letter or a symbol first, at least three words, a full stop."""
    summary = " ".join((docstring or "").strip().split("\n\n")[0].split())
    return len(summary.split()) >= 3 and summary.endswith(".") and not summary[0].islower()


def test_a_file_holds_one_idea_in_at_most_300_lines():
    lengths = {label(path): len(path.read_text(encoding="utf-8").splitlines()) for path in MODULES}
    assert {name: lines for name, lines in lengths.items() if lines > LONGEST_FILE} == {}


def complexity(function: ast.AST) -> int:
    """Count the paths through a function as McCabe does, with comprehensions, `and` and `or`."""
    inside = [node for node in ast.walk(function) if node is not function]
    inner = sum(isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) for node in inside)
    conditions = sum(len(node.ifs) for node in inside if isinstance(node, ast.comprehension))
    operands = sum(len(node.values) - 1 for node in inside if isinstance(node, ast.BoolOp))
    otherwise = sum(
        bool(node.orelse) for node in inside if isinstance(node, ast.For | ast.AsyncFor | ast.While | ast.Try)
    )
    branches = sum(isinstance(node, BRANCHES) for node in inside)
    return 1 + branches + inner + conditions + operands + otherwise


def test_few_functions_have_more_branches_than_a_reader_holds_in_mind():
    functions = [
        (f"{label(path)}:{node.name}", complexity(node))
        for path in MODULES
        for node in ast.walk(tree(path))
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
    ]
    over = [name for name, paths in functions if paths > MOST_BRANCHES]
    assert len(over) <= 0.013 * len(functions), over


@pytest.mark.parametrize(
    ("code", "paths"),
    [
        ("def f(): return 1", 1),
        ("def f(x): return [y for y in x if y or not y]", 4),
        ("def f(x):\n    for y in x: break\n    else: return 1 if x else 2", 4),
        ("def f(x):\n    def g():\n        try: x()\n        except E: pass", 3),
    ],
)
def test_paths_through_comprehensions_and_inner_functions_are_counted(code, paths):
    assert complexity(ast.parse(code).body[0]) == paths


def test_a_package_says_what_comes_in_and_goes_out_and_does_nothing_else():
    lacking = [path for path in PACKAGES if len(tree(path).body) != 1 or not ast.get_docstring(tree(path))]
    assert [label(path) for path in lacking] == []


def test_every_folder_with_code_is_a_package():
    assert [label(path) for path in MODULES if not (path.parent / "__init__.py").exists()] == []


def test_a_module_opens_with_what_it_is_and_why():
    assert [label(path) for path in MODULES if not is_sentence(ast.get_docstring(tree(path)))] == []


def test_every_public_name_of_core_is_explained_by_a_full_sentence():
    named = [(path, node) for path in CORE for node in public_definitions(tree(path))]
    silent = [(label(path), node.name) for path, node in named if not is_sentence(ast.get_docstring(node))]
    assert silent == []


def test_annotations_of_core_are_values_so_that_shapes_can_be_checked():
    imports = [
        (label(path), node.module)
        for path in CORE
        for node in tree(path).body
        if isinstance(node, ast.ImportFrom)
    ]
    assert imports
    assert [path for path, module in imports if module == "__future__"] == []


def test_there_are_files_to_hold_to_the_rules():
    assert min(len(MODULES), len(CORE), len(PACKAGES)) > 50


@pytest.mark.parametrize("docstring", [None, "", "Too short.", "no capital letter first.", "It never ends"])
def test_a_fragment_is_not_a_sentence(docstring):
    assert not is_sentence(docstring)


def test_shapes_are_checked_while_tests_run():
    from veritorque.core.robot.inertia import pseudo_inertia

    with pytest.raises(TypeCheckError):
        pseudo_inertia(np.zeros(9))
