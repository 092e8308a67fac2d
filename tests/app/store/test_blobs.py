"""Bytes that are set aside are removed once nobody holds them, and never while somebody does."""

import pytest

from veritorque.app.store.blobs.file_store import FileBlobStore


@pytest.fixture
def blobs(tmp_path):
    return FileBlobStore(tmp_path)


@pytest.fixture
def restarted(blobs, tmp_path):
    """The same directory as a service sees it that starts while a worker goes on."""
    return FileBlobStore(tmp_path)


def test_a_restart_leaves_what_a_worker_is_about_to_keep(blobs, restarted):
    with blobs.scratch_file() as traces:
        traces.write_bytes(b"torque")
        restarted.remove_leftovers()
        sha256 = blobs.put_file(traces)
    assert blobs.read(sha256) == b"torque"


def test_a_restart_leaves_what_another_process_receives(blobs, restarted):
    with blobs.receive() as incoming:
        incoming.write(b"time,q_1")
        restarted.remove_leftovers()
        sha256 = blobs.keep(incoming)
    assert blobs.read(sha256) == b"time,q_1"


def test_what_nobody_holds_any_more_is_removed(blobs, restarted, tmp_path):
    with blobs.scratch_file() as traces:
        traces.write_bytes(b"torque")
    aside = tmp_path / "incoming"
    assert list(aside.iterdir()) == []
    (aside / "half").write_bytes(b"time,q_1")
    (aside / "abandoned").mkdir()
    (aside / "abandoned" / "written").write_bytes(b"torque")
    restarted.remove_leftovers()
    assert list(aside.iterdir()) == []
