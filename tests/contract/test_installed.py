"""Install the wheel beside packages named `app` and `core`: one name, `veritorque`, comes in and works."""

import os
import shutil
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SOURCES = ("LICENSE", "README.md", "app", "core", "pyproject.toml", "veritorque")
EXAMPLE_LOGS = ("examples/yumi/log.csv", "examples/yumi/hidden_log.csv")
OFFLINE = ("--no-deps", "--no-index", "--quiet", "--disable-pip-version-check", "--no-input")


def run(*command: str | Path, cwd: Path) -> str:
    """Run without the settings of this process, and without compiling kernels."""
    kept = {
        name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "VERITORQUE"))
    }
    kept["NUMBA_DISABLE_JIT"] = "1"
    ended = subprocess.run(command, cwd=cwd, env=kept, capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    return ended.stdout.strip()


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """Build in a copy, because setuptools writes beside what it reads."""
    tree = tmp_path_factory.mktemp("checkout")
    for name in SOURCES:
        if (ROOT / name).is_dir():
            shutil.copytree(
                ROOT / name, tree / name, symlinks=True, ignore=shutil.ignore_patterns("__pycache__")
            )
        else:
            shutil.copy(ROOT / name, tree)
    for name in EXAMPLE_LOGS:
        (tree / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tree / name)
    build = (
        sys.executable,
        "-m",
        "pip",
        "wheel",
        *OFFLINE,
        "--no-build-isolation",
        "--wheel-dir",
        "wheels",
        ".",
    )
    run(*build, cwd=tree)
    return next((tree / "wheels").glob("veritorque-*.whl"))


@pytest.fixture(scope="module")
def environment(tmp_path_factory, wheel):
    """Install the wheel where the user has an `app` and a `core`; give the programs and the names added."""
    root = tmp_path_factory.mktemp("environment")
    run(sys.executable, "-m", "venv", "--without-pip", root, cwd=root.parent)
    python = root / "bin" / "python"
    packages = Path(run(python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))", cwd=root))
    (packages / "dependencies.pth").write_text(sysconfig.get_path("purelib"))
    for name in ("app", "core"):
        (packages / name).mkdir()
        (packages / name / "__init__.py").write_text(f"OWNER = 'the user of {name}'\n")
    before = {path.name for path in packages.iterdir()}
    run(sys.executable, "-m", "pip", "--python", python, "install", *OFFLINE, wheel, cwd=root)
    return root / "bin", {path.name for path in packages.iterdir()} - before


def files_of(folder: Path) -> set[str]:
    found = (path for path in folder.rglob("*") if path.is_file() and "__pycache__" not in path.parts)
    return {f"veritorque/{folder.name}/{path.relative_to(folder)}" for path in found}


def test_the_wheel_holds_every_file_of_the_package_and_no_other(wheel):
    members = zipfile.ZipFile(wheel).infolist()
    held = {member.filename for member in members if not member.filename.startswith("veritorque-")}
    own = {f"veritorque/{path.name}" for path in (ROOT / "veritorque").glob("*.py")}
    assert held == own | files_of(ROOT / "app") | files_of(ROOT / "core")
    assert not [member.filename for member in members if member.external_attr >> 28 == 0xA]  # a link
    assert not [member.filename for member in members if ".data/" in member.filename]


def test_an_environment_gets_one_name(environment):
    _, added = environment
    assert {name for name in added if not name.endswith(".dist-info")} == {"veritorque"}
    assert len(added) == 2


def test_the_public_names_work_and_packages_of_the_same_name_as_ours_are_left_alone(environment, tmp_path):
    binaries, _ = environment
    code = """
import app, core, veritorque
from veritorque import Client, Result, diagnose, identify, read_log
from veritorque.app.main import create_app
print(app.OWNER, core.OWNER, hasattr(app, "main"), hasattr(core, "study"), veritorque.__file__, sep="|")
"""
    *others, home = run(binaries / "python", "-c", code, cwd=tmp_path).split("|")
    assert others == ["the user of app", "the user of core", "False", "False"]
    assert Path(home).is_relative_to(binaries.parent)


def test_the_command_runs_from_anywhere(environment, tmp_path):
    binaries, _ = environment
    spoken = run(binaries / "veritorque", "version", cwd=tmp_path)
    assert spoken == run(binaries / "python", "-m", "veritorque", "version", cwd=tmp_path)
    assert "0.1.0" in spoken


def test_the_logs_of_the_start_page_are_installed(environment, tmp_path):
    binaries, _ = environment
    code = "from veritorque.app.pages.files import STATIC; print(len(STATIC['{}'].content()))"
    for served, original in (("example-log.csv", "log.csv"), ("example-hidden-log.csv", "hidden_log.csv")):
        size = (ROOT / "examples" / "yumi" / original).stat().st_size
        assert run(binaries / "python", "-c", code.format(served), cwd=tmp_path) == str(size)
