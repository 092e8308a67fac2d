"""Set the stage for every test: shapes are checked at run time, and a random law is the same law tomorrow.

The import hook has to be in place before core is imported, so nothing in this file imports core. Packages
with kernels compiled by numba are left out, because a wrapped function cannot be compiled. Slow tests go
without, and others check the first calls of each function (see `tests.shapes`).
"""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import HealthCheck, is_hypothesis_test, settings

from tests.shapes import CALLS, check_packages, start_test, start_with_each_case

CHECKED_PACKAGES = (
    "veritorque.core.diagnosis",
    "veritorque.core.dynamics",
    "veritorque.core.estimate",
    "veritorque.core.export",
    "veritorque.core.extension",
    "veritorque.core.log",
    "veritorque.core.precision",
    "veritorque.core.reduction",
    "veritorque.core.robot",
    "veritorque.core.signals",
    "veritorque.core.study",
    "veritorque.core.validation",
)

COMPILED = (("regressor", "simulation"), ("numerics",))
"""Packages of core with kernels, in two parts that share none: they are compiled at the same time."""

ROOT = Path(__file__).parent

collect_ignore = ["veritorque/app/store/migrations/env.py"]  # a script, which only Alembic can run

# Where `make serve` keeps its kernels: services that tests start compile none again.
os.environ.setdefault("NUMBA_CACHE_DIR", str(ROOT / "data" / "kernels"))

# Each of the many processes that tests start would compile every module again where bytecode is switched off.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False

check_packages(CHECKED_PACKAGES)

settings.register_profile(
    "veritorque",
    derandomize=True,  # a failure is seen again by whoever looks at it
    deadline=None,  # the first example may compile a kernel
    database=None,  # nothing is carried over from one run to the next
    suppress_health_check=[HealthCheck.too_slow],  # speed is measured in benchmarks, not on a shared machine
)
settings.load_profile("veritorque")


def pytest_configure(config: pytest.Config) -> None:
    """Compile the kernels once, before several processes that each would compile all of them are started."""
    if getattr(config.option, "numprocesses", None):
        compiling = [_compiling(*folders) for folders in COMPILED]
        for one in compiling:
            if one.wait():
                raise subprocess.CalledProcessError(one.returncode, one.args)


def _compiling(*folders: str) -> subprocess.Popen[bytes]:
    """Start a process that compiles the kernels of some packages of core, by importing their modules."""
    files = [file for folder in folders for file in sorted((ROOT / "core" / folder).rglob("*.py"))]
    names = [".".join(file.relative_to(ROOT).with_suffix("").parts) for file in files if _has_kernels(file)]
    modules = ", ".join(f"veritorque.{name}" for name in names)
    command = [sys.executable, "-c", f"import {modules}"]
    return subprocess.Popen(command, cwd=ROOT)  # noqa: S603  # modules of our own, without a shell


def _has_kernels(file: Path) -> bool:
    return "from numba import" in file.read_text(encoding="utf-8")


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """Check shapes unless the test is slow."""
    start_test(0 if item.get_closest_marker("slow") else CALLS)
    law = getattr(item, "obj", None)
    if is_hypothesis_test(law):
        start_with_each_case(law)
