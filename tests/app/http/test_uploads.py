"""A body arrives in pieces of any size: all are kept in order, and no failure leaves a writer behind."""

import hashlib
import threading

import anyio
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from starlette.requests import Request

from veritorque.app.http.body.uploads import AHEAD, PIECE, receive_body
from veritorque.app.problems import Problem
from veritorque.app.store.blobs.file_store import FileBlobStore
from veritorque.app.store.errors import UnavailableError

SCOPE = {"type": "http", "method": "POST", "path": "/v1/logs", "headers": []}


def request_of(pieces, ending):
    messages = [{"type": "http.request", "body": piece, "more_body": True} for piece in pieces]
    coming = iter([*messages, ending])

    async def receive():
        return next(coming)

    return Request(SCOPE, receive)


END = {"type": "http.request", "body": b"", "more_body": False}
GONE = {"type": "http.disconnect"}


def received(request, incoming):
    anyio.run(receive_body, request, incoming)


def writers():
    return [one.name for one in threading.enumerate() if one.name.startswith("upload")]


@settings(max_examples=20)
@given(st.lists(st.integers(0, PIECE // 2 + 3), max_size=12), st.integers(0, 255))
def test_all_bytes_are_kept_in_their_order(tmp_path_factory, sizes, first):
    pieces = [bytes([(first + number) % 256]) * size for number, size in enumerate(sizes)]
    with FileBlobStore(tmp_path_factory.mktemp("blobs")).receive() as incoming:
        received(request_of(pieces, END), incoming)
        incoming.finish()
        assert incoming.path.read_bytes() == b"".join(pieces)
        assert incoming.sha256 == hashlib.sha256(b"".join(pieces)).hexdigest()
        assert incoming.size == sum(sizes)


class Full:
    """Take one piece, and have no room for the next."""

    def __init__(self):
        self.taken = 0

    def write(self, piece):
        self.taken += 1
        if self.taken > 1:
            raise UnavailableError("the disk is full")


@pytest.mark.parametrize("pieces", [2, 2 + AHEAD, 40])
def test_a_disk_that_is_full_ends_an_upload_soon(pieces):
    full = Full()
    with pytest.raises(UnavailableError):
        received(request_of([bytes(PIECE)] * pieces, END), full)
    assert full.taken <= 3 + AHEAD
    assert writers() == []


@pytest.mark.parametrize("pieces", [0, 1, 3])
def test_a_client_that_goes_away_is_told_so_and_leaves_no_writer(tmp_path, pieces):
    with FileBlobStore(tmp_path).receive() as incoming:
        with pytest.raises(Problem, match="the upload ended early"):
            received(request_of([bytes(PIECE)] * pieces, GONE), incoming)
        assert writers() == []
        assert incoming.size == pieces * PIECE
