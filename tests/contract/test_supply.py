"""Hold what comes from elsewhere to its promise: locked, hashed, licensed, and without trace of a machine."""

import hashlib
import json
import re
import subprocess
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
LOCKS = sorted((ROOT / "docker").glob("requirements*.txt"))
MANIFESTS = sorted(path for folder in ("app", "tests") for path in (ROOT / folder).rglob("manifest.json"))
VENDOR = ROOT / "app" / "pages" / "vendor"

# Spelt in pieces, so that this file passes its own test.
REGISTRY_HOST = re.compile(
    "|".join(("pypi" + r"\.org", "python" + "hosted", "registry" + r"\.npmjs", "npmjs" + r"\.com"))
)
MACHINE_PATH = re.compile(r"(?<![\w.~-])/(?:work|root)/|file:///(?:opt|home)")


def label(path: Path) -> str:
    return str(path.relative_to(ROOT))


def committed_texts() -> Iterator[tuple[str, str]]:
    """Read every committed file that is text, apart from released bundles."""
    listing = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True)
    for name in filter(None, listing.stdout.split("\0")):
        path = ROOT / name
        if path.is_file() and not path.is_relative_to(VENDOR):
            yield name, path.read_bytes().decode("utf-8", errors="replace")


def blocks(lock: str) -> list[str]:
    """Split a lock into its requirements, continuation lines joined."""
    return [line for line in lock.replace("\\\n", " ").splitlines() if line.strip()]


def hashed_files(node: object) -> Iterator[tuple[str, str]]:
    """Find every file with its sha256, wherever in a manifest it stands."""
    if isinstance(node, dict):
        if "file" in node and "sha256" in node:
            yield node["file"], node["sha256"]
        for value in node.values():
            yield from hashed_files(value)
    elif isinstance(node, list):
        for value in node:
            yield from hashed_files(value)


@pytest.mark.parametrize("lock", LOCKS, ids=label)
def test_a_lock_pins_every_package_by_version_and_hash_and_names_no_registry(lock):
    text = lock.read_text()
    assert "://" not in text
    assert "--index-url" not in text
    assert blocks(text)
    loose = [
        line[:60]
        for line in blocks(text)
        if not re.match(r"^[\w.-]+(\[[\w,-]+\])?==\S+ .*--hash=sha256:", line)
    ]
    assert loose == []


def test_there_is_one_lock_to_run_and_one_to_develop():
    assert [lock.name for lock in LOCKS] == ["requirements-dev.txt", "requirements.txt"]
    run, develop = (
        set(re.findall(r"^([\w.-]+==\S+)", lock.read_text(), re.MULTILINE)) for lock in reversed(LOCKS)
    )
    assert run < develop


def test_every_declared_dependency_is_locked():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    extras = project["optional-dependencies"]
    to_run = [*project["dependencies"], *extras["postgres"], *extras["ros"]]
    for lock, declared in {"": to_run, "-dev": [*to_run, *extras["test"]]}.items():
        lines = blocks((ROOT / "docker" / f"requirements{lock}.txt").read_text())
        locked = {re.match(r"[\w.-]+", line).group() for line in lines}
        assert {re.match(r"[\w.-]+", requirement).group().lower() for requirement in declared} <= locked


def test_no_committed_file_names_a_registry_or_a_path_of_the_machine_it_was_made_on():
    found = [
        (name, match.group())
        for name, text in committed_texts()
        for match in (*REGISTRY_HOST.finditer(text), *MACHINE_PATH.finditer(text))
    ]
    assert found == []


@pytest.mark.parametrize(
    "trace", ["see /work" + "/main", "https://pypi" + ".org/simple", "'/root" + "/.venv'"]
)
def test_a_trace_of_the_machine_is_noticed(trace):
    assert MACHINE_PATH.search(trace) or REGISTRY_HOST.search(trace)


@pytest.mark.parametrize("manifest", MANIFESTS, ids=label)
def test_a_file_from_elsewhere_is_the_one_its_manifest_names(manifest):
    listed = dict(hashed_files(json.loads(manifest.read_text())))
    actual = {name: hashlib.sha256((manifest.parent / name).read_bytes()).hexdigest() for name in listed}
    assert listed
    assert actual == listed


def test_every_vendored_file_is_in_the_manifest_with_name_version_and_licence():
    manifest = json.loads((VENDOR / "manifest.json").read_text())
    listed = {name for name, _ in hashed_files(manifest)}
    present = {str(path.relative_to(VENDOR)) for path in VENDOR.rglob("*") if path.is_file()}
    assert present == listed | {"manifest.json"}
    for package in manifest["packages"]:
        assert all(package[fact] for fact in ("name", "version", "licence"))
