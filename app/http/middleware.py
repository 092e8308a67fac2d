"""Stand before every request: bodies are bounded, and no answer is guessed at by a browser."""

from collections.abc import Iterable

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from ..problems import Problem
from .disk_reserve import DiskReserve
from .exception_handlers import HEADERS, problem_response
from .refusals import too_large

DOCUMENT_LIMIT = 6 * 1024**2  # a URDF of 5 MB and its envelope
FORM_OVERHEAD = DOCUMENT_LIMIT
WITH_BODY = ("POST", "PUT", "PATCH")
UPLOAD_PATHS = ("/v1/logs", "/v1/identify")
LONGEST_NUMBER = 20
"""Digits of the largest length that can be declared, 2^64 - 1."""
LOOK_AT_DISK_EVERY = 16 * 1024**2
UNLESS_SAID = (
    (b"content-security-policy", b"default-src 'none'; frame-ancestors 'none'"),
    (b"cache-control", b"no-store"),
)
"""What stands in an answer that says nothing else about it."""


class BodyLimit:
    """Refuse bodies that are larger than the service takes, by their declared length or as they arrive.

    Parameters
    ----------
    app
        What comes next.
    upload_limit
        Largest upload in bytes; other bodies are documents and bounded by `DOCUMENT_LIMIT`.
    disk
        Where bodies go.
    """

    def __init__(self, app: ASGIApp, upload_limit: int, disk: DiskReserve) -> None:
        self._app, self._upload_limit, self._disk = app, upload_limit, disk

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one request."""
        if scope["type"] != "http" or scope["method"] not in WITH_BODY:
            await self._app(scope, receive, send)
            return
        limit, declared = self._limit(scope), _declared_length(scope)
        try:
            _refuse_codings(scope)
            if declared > limit:
                raise too_large(limit)
            self._disk.require(declared)
        except Problem as problem:
            await problem_response(problem)(scope, receive, send)
            return
        seen, looked = 0, 0

        async def counted() -> Message:
            nonlocal seen, looked
            message = await receive()
            seen += len(message.get("body", b""))
            if seen > limit:
                raise too_large(limit)
            if seen - looked > LOOK_AT_DISK_EVERY:
                looked = seen
                self._disk.require()
            return message

        await self._app(scope, counted, send)

    def _limit(self, scope: Scope) -> int:
        if scope["path"].rstrip("/") not in UPLOAD_PATHS:
            return DOCUMENT_LIMIT
        form = dict(scope["headers"]).get(b"content-type", b"").lower().startswith(b"multipart/")
        return self._upload_limit + (FORM_OVERHEAD if form else 0)


class SafeHeaders:
    """Tell browsers to take answers for what they are declared to be."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one request."""

        async def marked(message: Message) -> None:
            if message["type"] == "http.response.start":
                unchanged = message["status"] == 304  # what is kept already keeps what it said of itself
                message["headers"] = _complete(message.get("headers", ()), () if unchanged else UNLESS_SAID)
            await send(message)

        await self._app(scope, receive, marked)


class HeadAsGet:
    """Answer HEAD as GET without the body, as RFC 9110 (9.3.2) asks of every resource."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one request."""
        ended = False

        async def bodiless(message: Message) -> None:
            nonlocal ended
            if message["type"] == "http.response.start":
                await send(message)
            elif not ended:
                ended = True  # at once, since a stream of events would not end for long
                await send({"type": "http.response.body", "body": b""})

        if scope["type"] == "http" and scope["method"] == "HEAD":
            asked = {**scope, "method": "GET"}
            try:
                await self._app(asked, receive, bodiless)
            finally:
                scope["route"] = asked.get("route")
        else:
            await self._app(scope, receive, send)


def _complete(
    headers: Iterable[tuple[bytes, bytes]], unless_said: Iterable[tuple[bytes, bytes]]
) -> list[tuple[bytes, bytes]]:
    given = list(headers)
    said = {name for name, _ in given}
    return [*given, *HEADERS, *(header for header in unless_said if header[0] not in said)]


def _refuse_codings(scope: Scope) -> None:
    """Refuse bodies that would have to be decoded: they would be taken for what they are not."""
    headers = Headers(scope=scope)
    framing = ", ".join(headers.getlist("transfer-encoding")).strip().lower()
    if framing not in ("", "chunked"):
        raise Problem(
            "bad-request",
            "the body travels in a coding that is not known here",
            evidence={"transfer_encoding": framing},
            remedy="send it as it is, or in chunks: Transfer-Encoding: chunked",
        )
    coding = ", ".join(headers.getlist("content-encoding")).strip().lower()
    if coding not in ("", "identity"):
        raise Problem(
            "unsupported-media-type",
            "the body is compressed or otherwise coded",
            evidence={"content_encoding": coding},
            remedy="send it as it is, without Content-Encoding; Parquet is small by itself",
            headers={"Accept-Encoding": "identity"},
        )


def _declared_length(scope: Scope) -> int:
    value = dict(scope["headers"]).get(b"content-length", b"0")
    return int(value) if value.isdigit() and len(value) <= LONGEST_NUMBER else 0
