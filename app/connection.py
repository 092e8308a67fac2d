"""Serve one connection as uvicorn does, but not forever to those who say nothing.

uvicorn waits without end for the head and the body of a request, and for a client to take its answer: a few
hundred clients that stop in the middle hold a service for good. Here each connection is looked at twice a
second, and is given up once it has been slow for too many looks. Looks are counted, not seconds, so that no
client pays for a time in which the service itself was suspended. Source: RFC 9110, 15.5.9, on 408.
"""

import asyncio
from typing import Literal, Self

from httptools import HttpParserError, HttpParserUpgrade, HttpRequestParser
from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol

from app.documents import json_bytes
from app.handlers import HEADERS
from app.problems import MEDIA_TYPE, Problem

HEAD_LOOKS = 17
"""Looks at an unfinished head before it is given up: 8.5 s."""
BODY_LOOKS = 17
"""Looks between which a body has to have grown by `BODY_BYTES`."""
BODY_BYTES = 17 * 512
"""1 KiB/s: no link in use is slower."""
ANSWER_LOOKS = 120
"""Looks at a client that takes nothing of its answer before it is given up: a minute."""
LARGEST_HEAD = 128 * 1024


class Pieces:
    """Hold a body as it came, piece by piece: uvicorn copies each into an array, and out of it again."""

    def __init__(self) -> None:
        self._pieces: list[bytes] = []
        self._size = 0

    def __iadd__(self, piece: bytes) -> Self:
        """Take a piece."""
        self._pieces.append(piece)
        self._size += len(piece)
        return self

    def __len__(self) -> int:
        """Count the bytes."""
        return self._size

    def __bytes__(self) -> bytes:
        """Give all pieces; one alone as it is."""
        return self._pieces[0] if len(self._pieces) == 1 else b"".join(self._pieces)


class PatientConnection(HttpToolsProtocol):
    """Serve one connection, as long as its client is not too slow.

    In a phase, `_looks` were made and `_bytes` came; `_besides` came with a body since its last bytes.
    """

    _phase: Literal["quiet", "head", "body"] = "quiet"
    _looks = 0
    _bytes = 0
    _besides = 0
    _stalled = 0

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]  # TCP only
        """Expect a head: whoever connects has something to say."""
        super().connection_made(transport)
        self._enter("head")

    def data_received(self, data: bytes) -> None:
        """Take bytes; the first after an answer begin the next head."""
        self._unset_keepalive_if_required()
        if self._phase == "quiet" and self._idle:
            self._enter("head")
        if self._phase == "head":
            self._bytes += len(data)
        elif self._phase == "body":
            self._besides += len(data)
        try:
            self._parse(data)
        except HttpParserError as error:
            self._refuse(_not_http(str(error)))
        if self._phase == "head" and self._bytes > LARGEST_HEAD and not self.transport.is_closing():
            self._refuse(_head_too_large())
        elif self._besides > LARGEST_HEAD and not self.transport.is_closing():
            self._refuse(_trailers_too_large())

    def on_message_begin(self) -> None:
        """Notice the first byte of a request, perhaps while another is being answered."""
        super().on_message_begin()
        if self._phase != "head":
            self._enter("head")
            self._bytes = 1  # at least; only what comes after this read is all its own

    def on_header(self, name: bytes, value: bytes) -> None:
        """Keep what stands in a head; what follows a body is nobody's (RFC 9110, 6.5.1, on trailers)."""
        if self._phase == "head":
            super().on_header(name, value)

    def on_headers_complete(self) -> None:
        """Notice the end of a head."""
        if self.parser.should_upgrade():
            _refuse_connect(self.parser.get_method())
            return  # it is read again
        super().on_headers_complete()
        self._enter("body")

    def on_body(self, body: bytes) -> None:
        """Count the bytes of a body, and keep them as they came."""
        self._bytes += len(body)
        self._besides = 0
        if not self.cycle.body:
            self.cycle.body = Pieces()  # type: ignore[assignment]  # as much of an array as uvicorn asks for
        super().on_body(body)

    def on_message_complete(self) -> None:
        """Notice the end of a request."""
        if self.parser.should_upgrade():
            return
        super().on_message_complete()
        self._enter("head" if self._idle else "quiet")  # whoever was answered before is waited for now

    def look(self) -> None:
        """Give the connection up if its client has been slow for too long."""
        self._looks += 1
        waits = self.flow.write_paused or self.transport.is_closing()
        self._stalled = self._stalled + 1 if waits else 0
        if self._stalled > ANSWER_LOOKS:
            self.transport.abort()
        elif self.transport.is_closing():
            return
        elif self._phase == "head":
            self._look_at_head()
        elif self._phase == "body":
            self._look_at_body()

    @property
    def _idle(self) -> bool:
        return getattr(self.cycle, "response_complete", True)  # there is none before the first request

    def _parse(self, data: bytes | memoryview) -> None:
        """Read on; who offers another protocol is served in this one, as RFC 9110 (7.8) permits.

        The parser takes everything after such a head for the other protocol. A new one is given the head
        without the offer, and then the rest.
        """
        while True:
            try:
                self.parser.feed_data(data)
            except HttpParserUpgrade as offer:
                data = memoryview(data)[offer.args[0] :]
                head = self._head_without_offer()
                self.parser = HttpRequestParser(self)
                self.parser.set_dangerous_leniencies(lenient_data_after_close=True)  # as uvicorn does
                self.parser.feed_data(head)
            else:
                return

    def _head_without_offer(self) -> bytes:
        version = self.parser.get_http_version().encode()
        lines = [b"%b %b HTTP/%b" % (self.parser.get_method(), self.url, version)]
        lines += [b"%b: %b" % (name, value) for name, value in self.headers if name != b"upgrade"]
        return b"\r\n".join([*lines, b"", b""])

    def _enter(self, phase: Literal["quiet", "head", "body"]) -> None:
        self._phase, self._looks, self._bytes, self._besides = phase, 0, 0, 0

    def _look_at_head(self) -> None:
        if self._looks <= HEAD_LOOKS:
            return
        if self._bytes:
            self._refuse(_too_slow("the head of the request was not finished in time"))
        else:
            self.transport.close()  # opened ahead of need, as browsers do

    def _look_at_body(self) -> None:
        if self.flow.read_paused or self.cycle.waiting_for_100_continue:
            self._enter("body")  # it is the service that does not read on
        elif self._looks > BODY_LOOKS:
            if self._bytes < BODY_BYTES:
                self._refuse(_too_slow("the body of the request came too slowly"))
            self._enter("body")

    def _refuse(self, problem: Problem) -> None:
        """Say what is wrong where nothing else is being said, and close."""
        if self._idle or not self.cycle.response_started:
            self.transport.write(_raw(problem))
        self.transport.close()


def _raw(problem: Problem) -> bytes:
    """Write a problem as the bytes of an answer, where no application is there to write it."""
    body = json_bytes(problem.document())
    headers = [
        *HEADERS,
        (b"content-type", MEDIA_TYPE.encode()),
        (b"content-length", b"%d" % len(body)),
        (b"connection", b"close"),
    ]
    lines = [b"HTTP/1.1 %d %s" % (problem.status_code, problem.title.encode())]
    lines += [name + b": " + value for name, value in headers]
    return b"\r\n".join([*lines, b"", body])


def _refuse_connect(method: bytes) -> None:
    if method == b"CONNECT":
        raise ValueError("this is no proxy")


def _not_http(reason: str) -> Problem:
    return Problem(
        "bad-request",
        "the request is not HTTP/1.1 that can be read",
        evidence={"reason": reason},
        remedy="send it as RFC 9112 says; most clients do",
    )


def _too_slow(cause: str) -> Problem:
    return Problem(
        "too-slow",
        cause,
        evidence={"head_s": HEAD_LOOKS / 2, "body_bytes_per_s": 1024},
        remedy="send the request without long pauses",
    )


def _head_too_large() -> Problem:
    return Problem(
        "head-too-large",
        f"the head of the request is larger than {LARGEST_HEAD} bytes",
        evidence={"limit_bytes": LARGEST_HEAD},
        remedy="send a shorter address and fewer headers; a long mapping fits into a form",
    )


def _trailers_too_large() -> Problem:
    return Problem(
        "head-too-large",
        f"what goes with the body is larger than {LARGEST_HEAD} bytes",
        evidence={"limit_bytes": LARGEST_HEAD},
        remedy="send fewer trailers, or none: they are not read",
    )
