"""What is kept can be copied while it is used, restored elsewhere, examined, and let go of in time."""

import json
import shutil
import threading
from datetime import UTC, datetime, timedelta

import pytest
from sqlalchemy import update
from typer.testing import CliRunner

from tests.app.conftest import service
from tests.app.jobs.test_jobs import another, asked
from tests.app.postgres import cluster, new_database
from tests.app.stubs import StubExecutor, add_job
from veritorque.app.lifecycle.backup import NOTE, NoBackupError, back_up, restore
from veritorque.app.lifecycle.doctor import examine
from veritorque.app.lifecycle.retention import expire
from veritorque.app.settings import Settings
from veritorque.app.store.errors import DamagedError
from veritorque.app.store.records import JobRequestRecord
from veritorque.app.store.store import Store
from veritorque.app.store.tables import JOBS, LOGS, REPEATS, time_text
from veritorque.app.terminal.main import COMMANDS


@pytest.fixture
def filled(tmp_path, log_bytes):
    """A data directory with a robot, a log and the results of two jobs; gives the paths of all documents."""
    executor = StubExecutor()
    executor.release.set()
    with service(tmp_path / "data", executor) as client:
        request = asked(client, log_bytes)
        paths = [f"/v1/robots/{request['robot']}", f"/v1/logs/{request['logs'][0]}"]
        for body in (request, another(request)):
            job = client.post("/v1/jobs", json=body, headers={"Prefer": "wait=10"}).json()
            paths += [f"/v1/jobs/{job['id']}", job["links"]["results"]]
    return paths


def documents(directory, paths, **settings):
    with service(directory, **settings) as client:
        return [client.get(path).text for path in paths]


def opened(directory, url=None):
    return Store(directory, url)


def findings(directory, **settings):
    return list(examine(Settings(data_dir=directory, disk_reserve_bytes=0, **settings)))


def harm(directory, **settings):
    return {finding.subject: finding for finding in findings(directory, **settings) if finding.harm}


def test_a_backup_restored_into_a_second_directory_gives_the_same_documents(tmp_path, filled):
    store, second = opened(tmp_path / "data"), opened(tmp_path / "second")
    counts = back_up(store, tmp_path / "backup")
    assert restore(tmp_path / "backup", second) == counts
    store.close()
    second.close()
    assert documents(tmp_path / "second", filled) == documents(tmp_path / "data", filled)
    assert harm(tmp_path / "second") == {}


def test_a_backup_moves_to_postgresql_and_new_jobs_go_on_there(tmp_path, filled, log_bytes):
    with cluster() as folder:
        url = new_database(folder)
        store, second = opened(tmp_path / "data"), opened(tmp_path / "second", url)
        back_up(store, tmp_path / "backup")
        restore(tmp_path / "backup", second)
        second.close()
        store.close()
        before = documents(tmp_path / "data", filled)
        assert documents(tmp_path / "second", filled, database_url=url) == before
        with service(tmp_path / "second", database_url=url) as client:
            answer = client.post("/v1/jobs", json=another(asked(client, log_bytes), 9))
            assert answer.status_code == 202
        assert harm(tmp_path / "second", database_url=url) == {}


def test_a_backup_while_jobs_come_and_go_is_whole(tmp_path):
    store, end = opened(tmp_path / "data"), threading.Event()
    jobs = store.of("local").jobs

    def use():
        number = 0
        while not end.is_set():
            number += 1
            add_job(jobs, JobRequestRecord("identify", "yumi", (), {"number": number}))
            taken = store.work.claim("worker", most_per_tenant=99)
            store.keep_result((taken.id, taken.token), json.dumps(number).encode())

    using = threading.Thread(target=use)
    using.start()
    try:
        for round_ in range(5):
            back_up(store, tmp_path / f"backup-{round_}")
    finally:
        end.set()
        using.join()
        store.close()
    for round_ in range(5):
        assert harm(tmp_path / f"backup-{round_}") == {}
    copy = opened(tmp_path / "backup-4")
    assert len(copy.needed()) > 5
    copy.close()


def test_a_backup_that_was_cut_off_is_not_restored(tmp_path, filled):
    store, second = opened(tmp_path / "data"), opened(tmp_path / "second")
    back_up(store, tmp_path / "backup")
    (tmp_path / "backup" / NOTE).unlink()
    with pytest.raises(NoBackupError, match="no complete backup"):
        restore(tmp_path / "backup", second)
    store.close()
    second.close()


def test_nothing_is_overwritten_by_a_backup_or_a_restore(tmp_path, filled):
    store = opened(tmp_path / "data")
    back_up(store, tmp_path / "backup")
    with pytest.raises(NoBackupError, match="already"):
        back_up(store, tmp_path / "backup")
    with pytest.raises(NoBackupError, match="already"):
        restore(tmp_path / "backup", store)
    store.close()


def kept_file(directory):
    store = opened(directory)
    path = next(store.blobs.path(sha256) for sha256 in sorted(store.needed()))
    store.close()
    return path


def test_damaged_bytes_are_found_named_and_not_copied(tmp_path, filled):
    path = kept_file(tmp_path / "data")
    path.write_bytes(path.read_bytes()[:-1] + b"?")
    found = harm(tmp_path / "data")
    assert path.name in found["damaged bytes"].seen
    assert "job-" in found["damaged bytes"].remedy or "log-" in found["damaged bytes"].remedy
    store = opened(tmp_path / "data")
    with pytest.raises(DamagedError):
        back_up(store, tmp_path / "backup")
    store.close()


def test_missing_bytes_are_found(tmp_path, filled):
    path = kept_file(tmp_path / "data")
    path.unlink()
    assert path.name in harm(tmp_path / "data")["missing bytes"].seen


def test_needless_bytes_are_noted_and_removed_by_gc(tmp_path, filled, monkeypatch):
    store = opened(tmp_path / "data")
    orphan = store.blobs.path(store.blobs.put(b"nobody needs me"))
    store.close()
    assert "1 files are not needed" in " ".join(one.seen for one in findings(tmp_path / "data"))
    monkeypatch.setenv("VERITORQUE_DATA_DIR", str(tmp_path / "data"))
    run = CliRunner().invoke(COMMANDS, ["gc", "--pause-s", "0"])
    assert (run.exit_code, orphan.exists()) == (0, False)
    assert harm(tmp_path / "data") == {}


def test_a_damaged_database_is_found(tmp_path, filled):
    database = tmp_path / "data" / "veritorque.sqlite"
    content = bytearray(database.read_bytes())
    for start in range(4096, len(content), 4096):
        content[start : start + 100] = b"\xff" * 100
    database.write_bytes(content)
    assert "restore a backup" in harm(tmp_path / "data")["database"].remedy


def test_a_server_that_is_not_there_is_found(tmp_path):
    (tmp_path / "data").mkdir()
    url = f"postgresql+psycopg://nobody@/none?host={tmp_path}"
    assert "PostgreSQL runs" in harm(tmp_path / "data", database_url=url)["database"].remedy


def test_the_command_ends_with_one_where_harm_is_done(tmp_path, filled, monkeypatch):
    monkeypatch.setenv("VERITORQUE_DATA_DIR", str(tmp_path / "data"))
    monkeypatch.setenv("VERITORQUE_DISK_RESERVE_BYTES", "0")
    assert CliRunner().invoke(COMMANDS, ["doctor"]).exit_code == 0
    shutil.rmtree(tmp_path / "data" / "blobs")
    run = CliRunner().invoke(COMMANDS, ["doctor"])
    assert run.exit_code == 1
    assert "ERROR missing bytes" in run.stdout


def age(store, table, days):
    then = time_text(datetime.now(UTC) - timedelta(days=days))
    names = [name for name in ("created_at", "finished_at") if name in table.c]
    store.database.write(lambda c: c.execute(update(table).values(dict.fromkeys(names, then))))


def test_each_kind_is_kept_as_long_as_it_is_said(tmp_path, filled):
    store = opened(tmp_path / "data")
    add_job(store.of("local").jobs, JobRequestRecord("identify", "yumi", (), {}), key="k")
    for table in (JOBS, LOGS, REPEATS):
        age(store, table, days=10.0)
    kept_longer = dict.fromkeys(("successful", "failed", "dismissed", "logs", "repeats"), 10.1)
    assert set(expire(store.database, kept_longer).values()) == {0}
    assert expire(store.database, {"logs": 9.9}) == {"logs": 0}  # jobs still name it
    assert expire(store.database, {"failed": 9.9, "dismissed": 9.9, "repeats": 9.9}) == {
        "failed": 0,
        "dismissed": 0,
        "repeats": 1,
    }
    assert expire(store.database, {"successful": 9.9}) == {"successful": 2}
    assert expire(store.database, {"logs": 9.9}) == {"logs": 1}
    assert [job.state for job in store.of("local").jobs.page(limit=9)] == ["accepted"]
    store.close()
