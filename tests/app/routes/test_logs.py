import hashlib
import io
import json
import resource
import signal

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from tests.app.conftest import assert_problem
from tests.app.planar_arm import columns
from veritorque.app.schemas.logs import LogSummary
from veritorque.app.store.blobs.sweep import Sweep

CSV = {"Content-Type": "text/csv"}


def test_a_log_comes_back_as_a_summary_with_the_hash_of_its_bytes(client, log_bytes):
    answer = client.post("/v1/logs?name=swing.csv", content=log_bytes, headers=CSV)
    log = answer.json()
    assert answer.status_code == 201
    assert log["sha256"] == hashlib.sha256(log_bytes).hexdigest()
    assert log["bytes"] == len(log_bytes)
    assert (log["name"], log["samples"], log["joints"]) == ("swing.csv", 800, 2)
    assert log["rate_hz"] == pytest.approx(200.0)
    assert log["duration_s"] == pytest.approx(799 / 200)
    assert log["channels"] == ["position", "torque"]
    assert client.get(answer.headers["location"]).json() == log
    LogSummary.model_validate_json(answer.content)


def test_a_form_and_a_body_of_the_same_log_are_the_same_log(client, log_bytes):
    body = client.post("/v1/logs?name=swing.csv", content=log_bytes, headers=CSV).json()
    form = client.post("/v1/logs", files={"file": ("swing.csv", log_bytes, "text/csv")}).json()
    assert form["id"] == body["id"]


def test_another_mapping_of_the_same_bytes_is_another_log(client, log_bytes):
    mapping = json.dumps({"torque": {"columns": ["tau_1", "tau_2"], "unit": "mN m"}})
    plain = client.post("/v1/logs", content=log_bytes, headers=CSV).json()
    mapped = client.post("/v1/logs", content=log_bytes, headers=CSV, params={"mapping": mapping}).json()
    assert mapped["sha256"] == plain["sha256"]
    assert mapped["id"] != plain["id"]
    assert mapped["mapping"] == json.loads(mapping)
    assert client.delete(f"/v1/logs/{plain['id']}").status_code == 204
    for part in ((None, "\ufeff" + mapping), ("mapping.json", b"\xef\xbb\xbf" + mapping.encode())):
        form = {"mapping": part, "file": ("log", log_bytes, "text/csv")}
        assert client.post("/v1/logs", files=form).json()["id"] == mapped["id"]


def test_a_stored_log_read_with_another_mapping_is_the_log_that_an_upload_would_be(client, log_bytes):
    mapping = {"torque": {"columns": ["tau_2", "tau_1"], "unit": "N m", "scale": [1.0, -1.0]}}
    plain = client.post("/v1/logs?name=swing.csv", content=log_bytes, headers=CSV).json()
    answer = client.post(f"/v1/logs/{plain['id']}/readings", json={"mapping": mapping})
    assert answer.status_code == 201
    asked = {"name": "swing.csv", "mapping": json.dumps(mapping)}
    uploaded = client.post("/v1/logs", content=log_bytes, headers=CSV, params=asked).json()
    assert answer.json()["id"] == uploaded["id"] != plain["id"]
    assert answer.headers["location"] == f"/v1/logs/{uploaded['id']}"
    back = client.post(f"/v1/logs/{uploaded['id']}/readings", json={"mapping": {}}).json()
    assert back["id"] == plain["id"]


def test_a_reading_that_does_not_fit_is_refused_and_leaves_nothing_behind(client, log_bytes):
    log = client.post("/v1/logs", content=log_bytes, headers=CSV).json()
    path, before = f"/v1/logs/{log['id']}/readings", client.get("/v1/logs").json()
    wrong = {"torque": {"columns": ["nobody", "tau_2"]}}
    assert_problem(client.post(path, json={"mapping": wrong}), 422, "log")
    assert_problem(client.post(path, json={"mapping": [], "more": 1}), 422, "request")
    broken = client.post(path, content=b"{", headers={"Content-Type": "application/json"})
    assert_problem(broken, 400, "not-json")
    assert_problem(client.post(path, content=b"{}", headers=CSV), 415, "unsupported-media-type")
    assert_problem(client.post("/v1/logs/log-none/readings", json={"mapping": {}}), 404, "not-found")
    assert client.get("/v1/logs").json() == before
    assert list((client.app.state.services.settings.data_dir / "blobs" / "incoming").iterdir()) == []


def test_bytes_that_another_log_needs_outlive_a_deletion(client, log_bytes):
    kept = client.post("/v1/logs?name=kept", content=log_bytes, headers=CSV).json()
    gone = client.post("/v1/logs?name=gone", content=log_bytes, headers=CSV).json()
    path = client.app.state.services.store.blobs.path(kept["sha256"])
    sweep = Sweep(client.app.state.services.store)
    client.delete(f"/v1/logs/{gone['id']}")
    assert [sweep.run(), sweep.run()] == [0, 0]
    assert path.read_bytes() == log_bytes
    for log in client.get("/v1/logs").json()["logs"]:
        client.delete(f"/v1/logs/{log['id']}")
    sweep.run()
    assert sweep.run() > 0
    assert not path.exists()


def test_a_refused_log_leaves_nothing_behind(client, log_bytes):
    client.post("/v1/logs", content=log_bytes[:200], headers=CSV)
    store = client.app.state.services.settings.data_dir / "blobs"
    assert list((store / "incoming").iterdir()) == []
    assert_problem(client.get("/v1/logs/log-none"), 404, "not-found")


def test_columns_that_nobody_named_are_listed_and_kept_out(client, log_bytes):
    lines = log_bytes.decode().split("\n")
    wider = "\n".join(line + ("," + ("mood" if n == 0 else "1")) for n, line in enumerate(lines))
    log = client.post("/v1/logs", content=wider.encode(), headers=CSV).json()
    assert log["ignored_columns"] == ["mood"]


def _parquet(table):
    file = io.BytesIO()
    pq.write_table(pa.table(table), file)
    return file.getvalue(), "application/vnd.apache.parquet"


def _npz(table):
    file = io.BytesIO()
    np.savez(file, **table)
    return file.getvalue(), "application/x-npz"


@pytest.mark.parametrize("write", [_parquet, _npz])
def test_other_formats_hold_the_same_log(client, write):
    time, position, torque = columns(seconds=4.0)
    table = {"time": time} | {f"q_{j + 1}": position[:, j] for j in (0, 1)}
    content, media_type = write(table | {f"tau_{j + 1}": torque[:, j] for j in (0, 1)})
    log = client.post("/v1/logs", content=content, headers={"Content-Type": media_type}).json()
    assert (log["samples"], log["joints"]) == (800, 2)


def test_a_path_in_a_file_name_is_a_name_only(client, log_bytes):
    log = client.post("/v1/logs", files={"file": ("../../etc/passwd", log_bytes, "text/csv")}).json()
    assert log["name"] == "passwd"


def test_a_full_disk_is_told_and_leaves_nothing_behind(client, log_bytes):
    """A limit of this process on the size of files stands for the disk: the kernel refuses the same call."""
    stored = resource.getrlimit(resource.RLIMIT_FSIZE)
    before = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    incoming = client.app.state.services.store.directory / "blobs" / "incoming"
    resource.setrlimit(resource.RLIMIT_FSIZE, (len(log_bytes) // 2, stored[1]))
    try:
        answer = client.post("/v1/logs", content=log_bytes, headers={"Content-Type": "text/csv"})
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, stored)
        signal.signal(signal.SIGXFSZ, before)
    assert_problem(answer, 507, "disk-full")
    assert list(incoming.iterdir()) == []
