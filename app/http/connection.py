"""Serve one connection as uvicorn does, with time limits for slow clients.

uvicorn waits without limit for the head and the body of a request, and for a client to take its answer: a few
hundred clients that stop in the middle block a service for good. Here each connection is checked twice a
second, and closed once it has been slow for too many ticks. Ticks are counted, not seconds, so that no client
is charged for a time in which the service itself was suspended. Source: RFC 9110, 15.5.9, on 408.

This uses private names of uvicorn; `tests/app/http/test_uvicorn.py` lists them, and pyproject.toml pins
uvicorn.
"""

import asyncio
import re
from typing import Literal, cast

from httptools import HttpParserError, HttpParserUpgrade, HttpRequestParser
from uvicorn._types import ASGI3Application
from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol, RequestResponseCycle

from ..problems import Problem
from .refusals import (
    BODY_BYTES,
    BODY_TICKS,
    HEAD_TICKS,
    LARGEST_HEAD,
    head_too_large,
    not_http,
    refusal,
    stopping,
    too_slow,
    trailers_too_large,
)
from .uvicorn_parts import AnswerTransport, BodyChunks

ANSWER_TICKS = 120
"""Ticks for which a client may take nothing of its answer: a minute."""
CLOSING_TICKS = 20
"""Ticks for which a client may still send after the last answer: 10 s."""
CLOSING_BYTES = 256 * 1024**2
"""Bytes that it may send meanwhile, which are discarded."""
_WITHOUT_PATH = re.compile(rb"\A(\w+://[^/?]+)(\?|\Z)")
"""An address that names only the host means the root (RFC 9112, 3.2.2)."""
Phase = Literal["waiting", "head", "body", "refused", "closing"]


class TimedConnection(HttpToolsProtocol):
    """Serve one connection, as long as its client is not too slow.

    `_ticks` and `_bytes` count those of the present phase; `_extra_bytes` counts what came with a body since
    its last bytes. After a refusal nothing more is read: earlier requests are answered, then the refusal is
    sent.
    """

    _phase: Phase = "waiting"
    _answering: RequestResponseCycle | None = None
    _ticks = 0
    _bytes = 0
    _extra_bytes = 0
    _stalled = 0

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]  # TCP only
        """Expect the head of a request."""
        super().connection_made(transport)
        self._answer_transport = AnswerTransport(transport, self._close_after_answer)
        self._enter("head")

    def data_received(self, data: bytes) -> None:
        """Receive bytes; the first after an answer begin the next head."""
        self._unset_keepalive_if_required()
        if self._phase in ("refused", "closing"):
            self._discard(data)
            return
        if self._phase == "waiting" and self._idle:
            self._enter("head")
        if self._phase == "head":
            self._bytes += len(data)
        elif self._phase == "body":
            self._extra_bytes += len(data)
        try:
            self._parse(data)
        except HttpParserError as error:
            self._refuse(not_http(str(error)))
        if self._phase == "head" and self._bytes > LARGEST_HEAD:
            self._refuse(head_too_large())
        elif self._extra_bytes > LARGEST_HEAD:
            self._refuse(trailers_too_large())

    def on_message_begin(self) -> None:
        """Notice the first byte of a request, perhaps while another is being answered."""
        super().on_message_begin()
        if self._phase != "head":
            self._enter("head")
            self._bytes = 1  # at least; only what comes after this read is all its own

    def on_header(self, name: bytes, value: bytes) -> None:
        """Keep the fields of a head, and ignore trailers (RFC 9110, 6.5.1)."""
        if self._phase == "head":
            super().on_header(name, value)

    def on_headers_complete(self) -> None:
        """Notice the end of a head."""
        if self.parser.should_upgrade():
            _refuse_connect(self.parser.get_method())
            return  # it is read again
        self.url = _WITHOUT_PATH.sub(rb"\1/\2", self.url)
        super().on_headers_complete()
        self.cycle.transport = cast("asyncio.Transport", self._answer_transport)
        self._enter("body")

    def on_body(self, body: bytes) -> None:
        """Count the bytes of a body, and keep them as they came."""
        self._bytes += len(body)
        self._extra_bytes = 0
        if not self.cycle.body:
            self.cycle.body = BodyChunks()  # type: ignore[assignment]  # as much of an array as uvicorn asks for
        super().on_body(body)

    def on_message_complete(self) -> None:
        """Notice the end of a request."""
        if self.parser.should_upgrade():
            return
        super().on_message_complete()
        self._enter(
            "head" if self._idle else "waiting"
        )  # a client that has its answer may begin the next head

    def eof_received(self) -> bool:  # type: ignore[override]  # as asyncio has it, though not uvicorn
        """Still answer a client that has closed its sending side; a stream that has begun ends instead."""
        listens = self._phase in ("waiting", "refused") and not self._idle
        if not listens or self._answering is None or self._answering.response_started:
            return False
        self.cycle.keep_alive = False
        return True

    def on_response_complete(self) -> None:
        """Go on with the next request; read no more while others wait."""
        super().on_response_complete()
        if self.transport.is_closing():
            return
        if self.pipeline:
            self.flow.pause_reading()
        elif self._phase == "head" and self._bytes:
            self._unset_keepalive_if_required()

    def connection_lost(self, exc: Exception | None) -> None:
        """Tell all requests that wait for their answers, not only the last, that the client is gone."""
        for cycle in (self._answering, *(cycle for cycle, _ in self.pipeline)):
            if cycle is not None:
                _cancel(cycle)
        super().connection_lost(exc)
        self._answer_transport.close = self.transport.close  # it is not needed any more

    def tick(self) -> None:
        """Close the connection if its client has been slow for too long."""
        self._ticks += 1
        waits = self.flow.write_paused or self.transport.is_closing()
        self._stalled = self._stalled + 1 if waits else 0
        if self._stalled > ANSWER_TICKS:
            self.transport.abort()
        elif self.transport.is_closing():
            return
        elif self._phase == "closing" and self._ticks > CLOSING_TICKS:
            self.transport.close()
        elif self._phase == "head":
            self._check_head()
        elif self._phase == "body":
            self._check_body()

    def refuse_pending(self) -> None:
        """Refuse all requests that are not answered yet, because the service stops."""
        if self.flow.write_paused or self._phase == "closing":
            self.transport.abort()
            return
        if self._answering is None or self._answering.response_started:
            return
        for cycle in (self._answering, *(cycle for cycle, _ in self.pipeline)):
            _cancel(cycle)
        self.pipeline.clear()
        self._enter("refused")
        self._answer(stopping())

    @property
    def _idle(self) -> bool:
        return getattr(self.cycle, "response_complete", True)  # there is none before the first request

    def _parse(self, data: bytes | memoryview) -> None:
        """Parse bytes; an offer of another protocol is ignored, as RFC 9110 (7.8) permits.

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

    def _enter(self, phase: Phase) -> None:
        self._phase, self._ticks, self._bytes, self._extra_bytes = phase, 0, 0, 0

    def _check_head(self) -> None:
        if self.flow.read_paused:
            self._ticks = 0  # it is the service that does not read on
        if self._ticks <= HEAD_TICKS:
            return
        if self._bytes:
            self._refuse(too_slow("the head of the request was not finished in time"))
        else:
            self.transport.close()  # opened ahead of need, as browsers do

    def _check_body(self) -> None:
        if self.flow.read_paused or self.cycle.waiting_for_100_continue:
            self._enter("body")  # it is the service that does not read on
        elif self._ticks > BODY_TICKS:
            if self._bytes < BODY_BYTES:
                self._refuse(too_slow("the body of the request came too slowly"))
            else:
                self._enter("body")

    def _refuse(self, problem: Problem) -> None:
        """Refuse the present request after all earlier ones are answered, and close."""
        unfinished = self._phase == "body"
        self._enter("refused")
        if unfinished:
            if self.cycle.response_started:
                self.transport.close()
                return
            self._withdraw(self.cycle)
        self._answer(problem)

    def _close_after_answer(self) -> None:
        """Close after the last answer; read on while a client sends, or it would lose the answer."""
        if self.transport.is_closing() or self._phase not in ("body", "refused"):
            self.transport.close()
            return
        self._enter("closing")
        self.pipeline.clear()
        self.transport.write_eof()

    def _discard(self, data: bytes) -> None:
        self._bytes += len(data)
        if self._phase == "closing" and self._bytes > CLOSING_BYTES:
            self.transport.close()

    def _withdraw(self, cycle: RequestResponseCycle) -> None:
        """Leave the last request unanswered."""
        _cancel(cycle)
        if cycle is not self._answering:
            self.pipeline.popleft()

    def _answer(self, problem: Problem) -> None:
        """Answer with a problem after all other answers, and close."""
        before = self._answering
        self.cycle = RequestResponseCycle(
            scope={"type": "http", "method": "GET", "headers": []},  # type: ignore[typeddict-item]  # no request
            transport=cast("asyncio.Transport", self._answer_transport),
            flow=self.flow,
            logger=self.logger,
            access_logger=self.access_logger,
            access_log=False,
            default_headers=self.server_state.default_headers,
            message_event=asyncio.Event(),
            expect_100_continue=False,
            keep_alive=False,
            on_response=self.on_response_complete,
        )
        said = cast("ASGI3Application", refusal(problem))
        if before is None or before.response_complete or before.disconnected:
            self._start_asgi_task(self.cycle, said)
        else:
            self.pipeline.appendleft((self.cycle, said))

    def _start_asgi_task(self, cycle: RequestResponseCycle, app: ASGI3Application) -> None:
        self._answering = cycle
        super()._start_asgi_task(cycle, app)


def _cancel(cycle: RequestResponseCycle) -> None:
    cycle.disconnected = True
    cycle.message_event.set()


def _refuse_connect(method: bytes) -> None:
    if method == b"CONNECT":
        raise ValueError("this is no proxy")
