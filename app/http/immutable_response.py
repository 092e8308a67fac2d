"""Answer with stored bytes that never change, or with 304 where the client has them.

A blob is identified by its digest. What is written from it depends on the service's version as well. Source:
RFC 9110, 13.1.2, on If-None-Match.
"""

from collections.abc import Callable
from contextlib import AbstractContextManager, ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Final

import anyio
from fastapi import Header, Response
from fastapi.responses import FileResponse
from starlette.types import Receive, Scope, Send

from ..store.blobs.blob_store import BlobStore
from ..version import VERSION
from .negotiation import matches

IfNoneMatch = Annotated[str | None, Header(max_length=1000, description="ETags of known versions")]
UNCHANGED: Final[dict[int | str, dict[str, Any]]] = {304: {"description": "Not modified"}}


@dataclass(frozen=True)
class Blob:
    """Name a blob by its digest, and the store that keeps it."""

    sha256: str
    store: BlobStore

    def content(self) -> bytes:
        """Read the bytes.

        Raises
        ------
        DamagedError
            If they are missing, or do not have the digest.
        """
        return self.store.read(self.sha256)

    def check(self) -> None:
        """Return where the bytes are there and whole.

        Raises
        ------
        DamagedError
            If they are not.
        """
        self.store.check(self.sha256)

    def local_copy(self) -> AbstractContextManager[Path]:
        """Give a local file that holds the bytes."""
        return self.store.local_copy(self.sha256)

    def respond(self, if_none_match: str | None, form: str, answer: Callable[[], Response]) -> Response:
        """Give the answer, or 304 where the client has it.

        Parameters
        ----------
        form
            What is written from the bytes; empty for the bytes themselves.
        answer
            Makes the answer.
        """
        etag = f'"{self.sha256}-{form}-{VERSION}"' if form else f'"{self.sha256}"'
        response = Response(status_code=304) if matches(if_none_match, etag) else answer()
        response.headers.update({"ETag": etag, "Vary": "Accept", "Cache-Control": "private, no-cache"})
        return response


class BlobResponse(FileResponse):
    """Send a blob as a file to be saved, in chunks, since it may be long."""

    def __init__(self, blob: Blob, *, filename: str, media_type: str) -> None:
        super().__init__("", filename=filename, media_type=media_type)
        self._blob = blob

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Hold a local copy until it is sent."""
        with ExitStack() as held:
            self.path = await anyio.to_thread.run_sync(held.enter_context, self._blob.local_copy())
            await super().__call__(scope, receive, send)


def file_response(blob: Blob, name: str, media_type: str, if_none_match: str | None) -> Response:
    """Send a blob as a file, or 304.

    Raises
    ------
    DamagedError
        If its bytes are missing, or do not have its digest.
    """

    def whole() -> Response:
        blob.check()
        return BlobResponse(blob, filename=name, media_type=media_type)

    return blob.respond(if_none_match, "", whole)
