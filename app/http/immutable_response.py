"""Answer with what never changes, once: whoever has it is told so, and nothing is read or drawn again.

A result document is known by the hash of its bytes. What is drawn from it depends on the service's version as
well. Source: RFC 9110, 13.1.2, on If-None-Match.
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Final

from fastapi import Header, Response
from fastapi.responses import FileResponse

from ..store.blobs import check_file
from ..version import VERSION
from .negotiation import matches

IfNoneMatch = Annotated[str | None, Header(max_length=1000, description="ETags of known versions")]
UNCHANGED: Final[dict[int | str, dict[str, Any]]] = {304: {"description": "Not modified"}}


@dataclass(frozen=True)
class Result:
    """Name the bytes of a result document by their hash, and the file they are in."""

    sha256: str
    path: Path

    def content(self) -> bytes:
        """Read the document.

        Raises
        ------
        Damaged
            If the file is missing or not what it was.
        """
        self.check()
        return self.path.read_bytes()

    def check(self) -> None:
        """Return where the bytes are what they were.

        Raises
        ------
        Damaged
            If they are not.
        """
        check_file(self.path, self.sha256)

    def unless_known(self, if_none_match: str | None, form: str, answer: Callable[[], Response]) -> Response:
        """Give the answer, or 304 where the client has it.

        Parameters
        ----------
        form
            What is drawn from the document; empty for the document itself.
        answer
            Makes the answer.
        """
        etag = f'"{self.sha256}-{form}-{VERSION}"' if form else f'"{self.sha256}"'
        response = Response(status_code=304) if matches(if_none_match, etag) else answer()
        response.headers.update({"ETag": etag, "Vary": "Accept", "Cache-Control": "private, no-cache"})
        return response


def file_response(kept: Result, name: str, media_type: str, if_none_match: str | None) -> Response:
    """Send kept bytes as a file to be saved, piece by piece: it may be long.

    Raises
    ------
    Damaged
        If they are missing or not what they were.
    """

    def whole() -> Response:
        kept.check()
        return FileResponse(kept.path, media_type=media_type, filename=name)

    return kept.unless_known(if_none_match, "", whole)
