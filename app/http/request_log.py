"""Log every request: give it an id, measure its time, count it, and write a line.

Reads that succeed are counted only: clients that poll would fill the disk with lines.
"""

import logging
import re
import secrets
import time

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from .. import logging as service_log
from ..services.metrics import Metrics

LOGGER = logging.getLogger(__name__)
SAFE_METHODS = ("GET", "HEAD", "OPTIONS")
_FIELDS = re.compile(r"([0-9a-f]{2})-([0-9a-f]{32})-([0-9a-f]{16})-[0-9a-f]{2}(-.*)?")
_INVALID_VERSION = "ff"
_ONLY_VERSION = "00"
"""The version that has nothing after its four fields."""


class RequestLog:
    """Stand before everything else.

    Parameters
    ----------
    app
        What comes next.
    metrics
        Where requests are counted.
    """

    def __init__(self, app: ASGIApp, metrics: Metrics) -> None:
        self._app, self._metrics = app, metrics

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one request."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        begun, status = time.perf_counter(), 500  # unless an answer begins, it is the answer to a mistake
        request, trace = secrets.token_hex(8), trace_id(Headers(scope=scope).get("traceparent"))
        service_log.begin(request=request, trace=trace)
        scope.setdefault("state", {})["trace"] = trace

        async def noted(message: Message) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]
                message["headers"] = [*message.get("headers", []), (b"x-request-id", request.encode())]
            await send(message)

        try:
            await self._app(scope, receive, noted)
        finally:
            self._note(scope, status, time.perf_counter() - begun)

    def _note(self, scope: Scope, status: int, seconds: float) -> None:
        method, route = scope["method"], getattr(scope.get("route"), "path", "none")
        self._metrics.answered(method=method, route=route, status=status, seconds=seconds)
        level = logging.DEBUG if method in SAFE_METHODS and status < 400 else logging.INFO
        fields = {"method": method, "path": scope["path"], "status": status, "seconds": round(seconds, 6)}
        LOGGER.log(level, "answered", extra=fields)


def trace_id(traceparent: str | None) -> str:
    """Give the id of the trace that a header names; a new one where it is absent or not valid.

    Source: W3C Trace Context, level 1 (2021), section 3.2.

    Examples
    --------
    >>> trace_id("00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01")
    '4bf92f3577b34da6a3ce929d0e0e4736'
    """
    found = _FIELDS.fullmatch(traceparent or "")
    if found is None:
        return secrets.token_hex(16)
    version, trace, parent, more = found.groups()
    valid = version != _INVALID_VERSION and int(trace, 16) and int(parent, 16)
    return trace if valid and not (more and version == _ONLY_VERSION) else secrets.token_hex(16)
