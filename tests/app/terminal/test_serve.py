import json
import os
import subprocess
import sys

import pytest

from tests.app.terminal.conftest import run
from veritorque.app.main import create_app
from veritorque.app.settings import Settings, reaches_other_machines
from veritorque.app.store.lock import DirectoryLock
from veritorque.app.terminal.commands import serve
from veritorque.app.version import VERSION


@pytest.fixture
def listened(monkeypatch):
    """Catch the settings with which the service would listen."""
    caught = []
    monkeypatch.setattr(serve, "_listen", caught.append)
    return caught


def test_the_contract_is_printed_as_it_is_served():
    printed = run("openapi").stdout
    assert json.loads(printed) == create_app().openapi()
    assert printed == json.dumps(create_app().openapi(), indent=2) + "\n"


def test_the_version_is_printed():
    assert run("version").stdout == VERSION + "\n"


def test_settings_come_from_the_environment_and_the_command_line_wins(listened, tmp_path):
    environment = {"VERITORQUE_PORT": "9001", "VERITORQUE_WORKERS": "2", "VERITORQUE_DATA_DIR": str(tmp_path)}
    assert run("serve", **environment).exit_code == 0
    assert run("serve", "--port", "9002", **environment).exit_code == 0
    assert [(one.port, one.workers, one.data_dir) for one in listened] == [
        (9001, 2, tmp_path),
        (9002, 2, tmp_path),
    ]


def test_every_setting_of_the_command_line_is_documented_with_its_variable():
    shown = run("serve", "--help").stdout
    for name in set(Settings.model_fields):
        assert f"VERITORQUE_{name.upper()}" in shown, name


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.168.1.5", "robot.example"])  # noqa: S104  (to be refused)
def test_an_address_that_others_can_reach_needs_a_key(listened, tmp_path, host):
    kept = {"VERITORQUE_DATA_DIR": str(tmp_path)}
    refused = run("serve", "--host", host, **kept)
    assert refused.exit_code == 2
    assert "keys create" in refused.output
    assert listened == []
    assert run("keys", "create", "lab", **kept).exit_code == 0
    assert (run("serve", "--host", host, **kept).exit_code, len(listened)) == (0, 1)
    identity = run("keys", "list", **kept).stdout.split()[0]
    assert run("keys", "revoke", identity, **kept).exit_code == 0
    assert run("serve", "--host", host, **kept).exit_code == 2


def test_the_secret_of_a_key_is_printed_once_and_kept_nowhere(tmp_path):
    kept = {"VERITORQUE_DATA_DIR": str(tmp_path)}
    secret = run("keys", "create", "lab", "--scopes", "read", **kept).stdout.strip()
    assert len(secret) > 40
    listed = run("keys", "list", **kept).stdout
    assert "lab  read  since" in listed
    assert secret not in listed
    stored = b"".join(path.read_bytes() for path in tmp_path.rglob("*") if path.is_file())
    assert secret.encode() not in stored
    assert run("keys", "create", "lab", "--scopes", "fly", **kept).exit_code == 2


def test_loopback_is_loopback():
    assert [reaches_other_machines(host) for host in ("127.0.0.1", "127.9.9.9", "::1", "localhost")] == [
        False
    ] * 4


def test_a_setting_that_makes_no_sense_is_refused_with_its_name(listened):
    for arguments, name in ((("--port", "70000"), "port"), (("--workers", "-1"), "workers")):
        refused = run("serve", *arguments)
        assert refused.exit_code == 2
        assert name in refused.output
    refused = run("serve", VERITORQUE_DISK_RESERVE_BYTES="perhaps")
    assert (refused.exit_code, listened) == (2, [])


def test_a_directory_that_cannot_be_written_is_refused_with_a_remedy(listened, tmp_path):
    (tmp_path / "file").touch()
    refused = run("serve", "--data-dir", str(tmp_path / "file"))
    assert refused.exit_code == 2
    assert "--data-dir" in refused.output
    assert listened == []


def test_linear_algebra_is_told_to_use_one_thread_before_it_is_loaded(listened, tmp_path):
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        os.environ.pop(name, None)
    os.environ["MKL_NUM_THREADS"] = "3"
    run("serve", "--data-dir", str(tmp_path))
    chosen = [os.environ[name] for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")]
    assert chosen == ["1", "1", "3"]
    loaded = "import sys, veritorque.app.terminal.commands.serve; sys.exit('numpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", loaded], check=False).returncode == 0


def test_the_first_compilation_is_announced_once(listened, tmp_path, monkeypatch):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "kernels"))
    assert "compiling once" in run("serve", "--data-dir", str(tmp_path)).output
    (tmp_path / "kernels" / "core").mkdir(parents=True)
    (tmp_path / "kernels" / "core" / "kernel.nbi").touch()
    assert "compiling" not in run("serve", "--data-dir", str(tmp_path)).output


def test_a_directory_that_another_service_uses_is_refused_with_a_remedy(listened, tmp_path):
    lock = DirectoryLock(tmp_path)
    refused = run("serve", "--data-dir", str(tmp_path))
    lock.release()
    assert (refused.exit_code, listened) == (2, [])
    assert "another service uses" in refused.output
    assert run("serve", "--data-dir", str(tmp_path)).exit_code == 0


@pytest.mark.parametrize(
    ("address", "reason"),
    [
        ("nonsense", "database_url"),
        ("mysql://host/name", "database_url"),
        ("postgresql://nobody:secret@127.0.0.1:1/none", "the database does not answer"),
    ],
)
def test_a_database_that_cannot_be_opened_is_refused_without_giving_its_password_away(
    listened, tmp_path, address, reason
):
    told = {"VERITORQUE_DATA_DIR": str(tmp_path), "VERITORQUE_DATABASE_URL": address}
    for command in (("serve",), ("work",), ("keys", "list")):
        refused = run(*command, **told)
        assert (refused.exit_code, listened) == (2, []), command
        assert reason in refused.output
        assert "secret" not in refused.output
