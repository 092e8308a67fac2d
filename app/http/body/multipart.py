"""Read multipart forms whole: one that was cut off on the way is none, however well its parts look.

Source: RFC 2046, 5.1.1, on boundaries.
"""

import re
from collections.abc import AsyncGenerator

from python_multipart.multipart import parse_options_header
from starlette.datastructures import FormData
from starlette.formparsers import MultiPartException, MultiPartParser
from starlette.requests import Request

LONGEST_PREAMBLE = 64 * 1024
CHARSETS = (b"utf-8", b"utf8", b"us-ascii")
"""A codec is code that a client would choose: some are no charsets, some take minutes."""


async def parse_form(request: Request, *, most_parts: int, longest_text: int) -> FormData:
    """Read a form from the body of a request.

    Raises
    ------
    MultiPartException, FormParserError, ClientDisconnect, ValueError, KeyError
        If it is none.
    """
    charset = _options(request.headers["content-type"]).get(b"charset", CHARSETS[0])
    if charset.lower() not in CHARSETS:
        raise MultiPartException("its charset is not UTF-8")
    return await _WholeForm(request, most_parts, longest_text).parse()


class _WholeForm(MultiPartParser):
    """Read a form up to the boundary that ends it."""

    def __init__(self, request: Request, most_parts: int, longest_text: int) -> None:
        super().__init__(
            request.headers,
            self._whole(request.stream()),
            max_files=most_parts,
            max_fields=most_parts,
            max_part_size=longest_text,
        )
        self._ended = False

    def on_end(self) -> None:
        """Notice the last boundary."""
        self._ended = True

    def on_part_end(self) -> None:
        """Refuse a text that is not written as the form says, which is UTF-8 if it says nothing."""
        if self._current_part.file is None:
            self._current_part.data.decode(self._charset)
        super().on_part_end()

    async def _whole(self, pieces: AsyncGenerator[bytes]) -> AsyncGenerator[bytes]:
        async for piece in _from_boundary(pieces, _options(self.headers["content-type"])[b"boundary"]):
            yield piece
        if not self._ended:
            raise MultiPartException("it ends before its last boundary")


async def _from_boundary(pieces: AsyncGenerator[bytes], boundary: bytes) -> AsyncGenerator[bytes]:
    """Leave out what stands before the first boundary, which is for readers that know no forms."""
    delimiter = b"--" + boundary
    line = re.compile(b"\r\n" + re.escape(delimiter) + rb"(?:[ \t]*(?=\r\n)|(?=--))")
    seen = b"\r\n"
    async for piece in pieces:
        seen += piece
        first = line.search(seen)
        if len(seen if first is None else seen[: first.start()]) > LONGEST_PREAMBLE:
            raise MultiPartException(f"no boundary is in its first {LONGEST_PREAMBLE} bytes")
        if first is not None:
            yield delimiter + seen[first.end() :]
            break
    async for piece in pieces:
        yield piece


def _options(content_type: str) -> dict[bytes, bytes]:
    return parse_options_header(content_type)[1]
