"""Stand before every request: bodies are bounded, and no answer is guessed at by a browser."""

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.handlers import problem_response
from app.problems import Problem

DOCUMENT_LIMIT = 6 * 1024**2  # a URDF of 5 MB and its envelope
FORM_OVERHEAD = DOCUMENT_LIMIT
UPLOAD_PATHS = ("/v1/logs", "/v1/identify")
HEADERS = [(b"x-content-type-options", b"nosniff"), (b"referrer-policy", b"no-referrer")]


class BodyLimit:
    """Refuse bodies that are larger than the service takes, by their declared length or as they arrive.

    Parameters
    ----------
    app
        What comes next.
    upload_limit
        Largest upload in bytes; other bodies are documents and bounded by `DOCUMENT_LIMIT`.
    """

    def __init__(self, app: ASGIApp, upload_limit: int) -> None:
        self._app, self._upload_limit = app, upload_limit

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one request."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        limit = self._limit(scope)
        if _declared_length(scope) > limit:
            await problem_response(_too_large(limit))(scope, receive, send)
            return
        seen = 0

        async def counted() -> Message:
            nonlocal seen
            message = await receive()
            seen += len(message.get("body", b""))
            if seen > limit:
                raise _too_large(limit)
            return message

        await self._app(scope, counted, send)

    def _limit(self, scope: Scope) -> int:
        if scope["path"].rstrip("/") not in UPLOAD_PATHS:
            return DOCUMENT_LIMIT
        form = dict(scope["headers"]).get(b"content-type", b"").startswith(b"multipart/")
        return self._upload_limit + (FORM_OVERHEAD if form else 0)


class SafeHeaders:
    """Tell browsers to take answers for what they are declared to be."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one request."""

        async def marked(message: Message) -> None:
            if message["type"] == "http.response.start":
                message["headers"] = [*message.get("headers", []), *HEADERS]
            await send(message)

        await self._app(scope, receive, marked)


class HeadAsGet:
    """Answer HEAD as GET without the body, as RFC 9110 (9.3.2) asks of every resource."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one request."""

        async def bodiless(message: Message) -> None:
            if message["type"] == "http.response.body":
                message = {**message, "body": b""}
            await send(message)

        if scope["type"] == "http" and scope["method"] == "HEAD":
            await self._app({**scope, "method": "GET"}, receive, bodiless)
        else:
            await self._app(scope, receive, send)


def _declared_length(scope: Scope) -> int:
    value = dict(scope["headers"]).get(b"content-length", b"0")
    return int(value) if value.isdigit() and len(value) < 20 else 0


def _too_large(limit: int) -> Problem:
    return Problem(
        "too-large",
        f"the body is larger than {limit} bytes",
        evidence={"limit_bytes": limit},
        remedy="send less, as Parquet perhaps, or let the operator raise VERITORQUE_MAX_UPLOAD_BYTES",
        headers={"Connection": "close"},
    )
