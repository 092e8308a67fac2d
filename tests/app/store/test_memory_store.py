"""A job runs the same on a blob store that keeps its bytes in memory: nothing asks for their paths."""

import io
import secrets
from contextlib import contextmanager

import pytest

from tests.app.conftest import service
from tests.app.jobs.test_jobs import asked
from tests.app.stubs import InlineExecutor
from veritorque.app.store import store as module
from veritorque.app.store.blobs.blob_store import BlobStore
from veritorque.app.store.blobs.incoming import Incoming


class MemoryBlobStore(BlobStore):
    def __init__(self, root):
        self._root, self._blobs = root, {}
        root.mkdir()

    def receive(self):
        return Incoming(self._root / secrets.token_hex(8))

    def keep(self, incoming):
        incoming.finish()
        self._blobs[incoming.sha256] = incoming.path.read_bytes(), (0, secrets.randbits(32))
        return incoming.sha256

    def open(self, sha256):
        if sha256 not in self._blobs:
            raise FileNotFoundError(sha256)
        return io.BytesIO(self._blobs[sha256][0])

    @contextmanager
    def local_copy(self, sha256):
        with self.scratch_file() as path:
            if sha256 in self._blobs:
                path.write_bytes(self._blobs[sha256][0])
            yield path

    @contextmanager
    def scratch_file(self):
        path = self._root / secrets.token_hex(8)
        try:
            yield path
        finally:
            path.unlink(missing_ok=True)

    def marks(self):
        return {sha256: mark for sha256, (_, mark) in self._blobs.items()}

    def remove(self, sha256, mark):
        if self.marks().get(sha256) == mark:
            del self._blobs[sha256]

    def remove_leftovers(self):
        pass


@pytest.fixture
def client(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "FileBlobStore", MemoryBlobStore)
    with service(tmp_path, InlineExecutor()) as client:
        yield client


def test_a_log_becomes_a_result_a_report_and_traces(client, log_bytes, tmp_path):
    job = client.post("/v1/jobs", json=asked(client, log_bytes), headers={"Prefer": "wait=60"}).json()
    assert job["state"] == "successful", job
    links = job["links"]
    assert client.get(links["results"]).json()["kind"] == "identify"
    assert client.get(links["report"]).status_code == 200
    assert client.get(f"{links['results']}/residuals.parquet").content.startswith(b"PAR1")
    assert client.get(f"{links['traces']}?joint=1").status_code == 200
    assert list((tmp_path / "blobs").iterdir()) == []  # every local copy is gone
