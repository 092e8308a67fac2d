"""Hold the code to who may import whom, and show that each contract refuses what it is there to refuse.

The contracts stand in pyproject.toml and are run by import-linter; the negative controls lay out a tiny tree
of packages with one forbidden import and run one contract on it.
"""

import os
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
LINTER = Path(sys.executable).with_name("lint-imports")
CONTRACTS = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"]["contracts"]

SKELETON = (
    "veritorque.core.arrays",
    "veritorque.core.diagnosis.checks",
    "veritorque.core.diagnosis.search",
    "veritorque.core.dynamics.terms",
    "veritorque.core.errors",
    "veritorque.core.estimate.programme",
    "veritorque.core.estimator_comparison",
    "veritorque.core.log.model",
    "veritorque.core.regressor.kernel",
    "veritorque.core.joint_identification",
    "veritorque.core.robot.model",
    "veritorque.core.robot_audit",
    "veritorque.core.setup_check",
    "veritorque.core.study",
    "veritorque.app.jobs.worker",
    "veritorque.app.kinds.identify",
    "veritorque.app.main",
    "veritorque.app.routes.logs",
    "veritorque.app.routes.robots",
    "tests.plant.friction",
)

ALLOWED = (
    ("veritorque.app.kinds.identify", "veritorque.core.study"),
    ("veritorque.app.routes.robots", "veritorque.app.jobs.worker"),
    ("veritorque.core.dynamics.terms", "veritorque.core.robot.model"),
    ("veritorque.core.estimate.programme", "cvxpy"),
    ("veritorque.core.regressor.kernel", "numba"),
    ("veritorque.core.study", "veritorque.core.estimate.programme"),
    ("tests.plant.friction", "veritorque.core.robot.model"),
    ("tests.plant.friction", "veritorque.core.log.model"),
    ("tests.plant.friction", "pinocchio"),
)

REFUSED = (
    ("app-over-core", "veritorque.core.study", "veritorque.app.main"),
    ("app-over-core", "veritorque.app.main", "tests.plant.friction"),
    ("core-without-http", "veritorque.core.robot.model", "pydantic"),
    ("core-without-http", "veritorque.core.errors", "starlette"),
    ("chapters-in-order", "veritorque.core.robot.model", "veritorque.core.log.model"),
    ("chapters-in-order", "veritorque.core.dynamics.terms", "veritorque.core.regressor.kernel"),
    ("chapters-in-order", "veritorque.core.errors", "veritorque.core.arrays"),
    ("chapters-in-order", "veritorque.core.helpers", "veritorque.core.errors"),  # a folder without a place
    ("rooms-of-the-diagnosis", "veritorque.core.diagnosis.search", "veritorque.core.diagnosis.checks"),
    ("rooms-of-the-diagnosis", "veritorque.core.diagnosis.helpers", "veritorque.core.errors"),
    ("solvers-in-estimate", "veritorque.core.regressor.kernel", "cvxpy"),
    ("solvers-in-estimate", "veritorque.app.main", "clarabel"),
    ("compiled-kernels", "veritorque.core.dynamics.terms", "numba"),
    ("routes-without-core", "veritorque.app.routes.logs", "veritorque.core.log.model"),
    ("routes-apart", "veritorque.app.routes.logs", "veritorque.app.routes.robots"),
    ("study-by-kinds", "veritorque.app.main", "veritorque.core.study"),
    ("study-by-kinds", "veritorque.app.routes.robots", "veritorque.core.study"),
    ("study-by-kinds", "veritorque.app.jobs.worker", "veritorque.core.study"),
    ("plant-apart", "tests.plant.friction", "veritorque.core.dynamics.terms"),
    ("plant-apart", "tests.plant.friction", "veritorque.app.main"),
)


def lay_out(tree: Path, imports: tuple[tuple[str, str], ...]) -> None:
    """Write packages which hold nothing but the given imports, under the project's own contracts."""
    shutil.copy(ROOT / "pyproject.toml", tree)
    for module in {*SKELETON, *(importer for importer, _ in imports)}:
        path = tree.joinpath(*module.split(".")).with_suffix(".py")
        path.parent.mkdir(parents=True, exist_ok=True)
        for package in path.parents[: len(module.split(".")) - 1]:
            (package / "__init__.py").touch()
        path.write_text(
            "".join(f"import {imported}\n" for importer, imported in imports if importer == module)
        )


def lint(tree: Path, *contracts: str) -> subprocess.CompletedProcess[str]:
    """Run import-linter on a tree, by all contracts or by those named."""
    chosen = [word for contract in contracts for word in ("--contract", contract)]
    return subprocess.run(
        [LINTER, "--no-logo", "--no-cache", *chosen],
        cwd=tree,
        env={**os.environ, "NO_COLOR": "1"},
        capture_output=True,
        text=True,
        check=False,
    )


def test_every_module_of_the_project_imports_only_what_it_may():
    result = lint(ROOT)
    assert result.returncode == 0, result.stdout + result.stderr


def test_the_imports_that_the_method_needs_are_allowed(tmp_path):
    lay_out(tmp_path, ALLOWED)
    result = lint(tmp_path)
    assert result.returncode == 0, result.stdout + result.stderr


@pytest.mark.parametrize(("contract", "importer", "imported"), REFUSED)
def test_a_forbidden_import_is_refused_by_its_contract(tmp_path, contract, importer, imported):
    lay_out(tmp_path, (*ALLOWED, (importer, imported)))
    result = lint(tmp_path, contract)
    assert result.returncode == 1, result.stdout + result.stderr
    assert "0 kept, 1 broken" in result.stdout
    assert importer in result.stdout


def test_every_contract_has_been_seen_to_refuse_something():
    assert {contract["id"] for contract in CONTRACTS} == {contract for contract, _, _ in REFUSED}


def test_a_service_starts_without_what_only_its_computations_need():
    heavy = {"clarabel", "numba", "scipy", "sklearn"}
    code = f"import sys, veritorque.app.main; print(*sorted({heavy} & set(sys.modules)))"
    loaded = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert not loaded.stdout.split()


def test_a_service_reads_the_options_of_every_kind_without_what_only_its_computations_need():
    heavy = {"clarabel", "numba", "sklearn"}
    code = (
        "import sys; from veritorque.app.kinds.registry import KINDS; "
        "[kind.read_example() for kind in KINDS.values()]; "
        f"print(*sorted({heavy} & set(sys.modules)))"
    )
    loaded = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert not loaded.stdout.split()


def test_the_study_loads_nothing_that_only_tests_or_some_computations_need():
    late = {
        "beartype",
        "jaxtyping",
        "numba",
        "pyarrow",
        "scipy.interpolate",
        "scipy.ndimage",
        "scipy.optimize",
    }
    late |= {
        "scipy.signal",
        "scipy.stats",
        "sklearn",
        "veritorque.core.diagnosis",
        "veritorque.core.extension.extend",
    }
    code = f"import sys, veritorque.core.study; print(*sorted({late} & set(sys.modules)))"
    loaded = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert not loaded.stdout.split()
