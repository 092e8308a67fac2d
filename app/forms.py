"""Read multipart forms whole: one that was cut off on the way is none, however well its parts look.

Source: RFC 2046, 5.1.1, on boundaries.
"""

from collections.abc import AsyncGenerator

from starlette.datastructures import FormData
from starlette.formparsers import MultiPartException, MultiPartParser
from starlette.requests import Request


async def parse_form(request: Request, *, most_parts: int, longest_text: int) -> FormData:
    """Read a form from the body of a request.

    Raises
    ------
    MultiPartException, FormParserError, ClientDisconnect, ValueError, KeyError
        If it is none.
    """
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

    async def _whole(self, pieces: AsyncGenerator[bytes]) -> AsyncGenerator[bytes]:
        async for piece in pieces:
            yield piece
        if not self._ended:
            raise MultiPartException("it ends before its last boundary")
