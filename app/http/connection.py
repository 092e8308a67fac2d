"""Serve one connection as uvicorn does, but not forever to those who say nothing.

uvicorn waits without end for the head and the body of a request, and for a client to take its answer: a few
hundred clients that stop in the middle hold a service for good. Here each connection is looked at twice a
second, and is given up once it has been slow for too many looks. Looks are counted, not seconds, so that no
client pays for a time in which the service itself was suspended. Source: RFC 9110, 15.5.9, on 408.
"""

import asyncio
import re
from collections.abc import Callable
from typing import Literal, cast

from httptools import HttpParserError, HttpParserUpgrade, HttpRequestParser
from uvicorn._types import ASGI3Application
from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol, RequestResponseCycle

from ..problems import Problem
from .body.chunks import Pieces
from .refusals import (
    BODY_BYTES,
    BODY_LOOKS,
    HEAD_LOOKS,
    LARGEST_HEAD,
    head_too_large,
    not_http,
    refusal,
    stopping,
    too_slow,
    trailers_too_large,
)

ANSWER_LOOKS = 120
"""Looks at a client that takes nothing of its answer before it is given up: a minute."""
PARTING_LOOKS = 20
"""Looks at a client that still sends after the last answer before the connection is cut: 10 s."""
PARTING_BYTES = 256 * 1024**2
"""What it may send meanwhile, which is thrown away."""
_WITHOUT_PATH = re.compile(rb"\A(\w+://[^/?]+)(\?|\Z)")
"""An address that names only the host means the root (RFC 9112, 3.2.2)."""
Phase = Literal["quiet", "head", "body", "deaf", "parting"]


class Ending:
    """Stand before a transport for those who answer, and let somebody else close it."""

    def __init__(self, transport: asyncio.Transport, close: Callable[[], None]) -> None:
        self.write, self.is_closing, self.close = transport.write, transport.is_closing, close


class PatientConnection(HttpToolsProtocol):
    """Serve one connection, as long as its client is not too slow.

    In a phase, `_looks` were made and `_bytes` came; `_besides` came with a body since its last bytes. Where
    something was refused, no more is read: what was asked before is answered, then what was refused.
    """

    _phase: Phase = "quiet"
    _answering: RequestResponseCycle | None = None
    _looks = 0
    _bytes = 0
    _besides = 0
    _stalled = 0

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]  # TCP only
        """Expect a head: whoever connects has something to say."""
        super().connection_made(transport)
        self._ending = Ending(transport, self._part)
        self._enter("head")

    def data_received(self, data: bytes) -> None:
        """Take bytes; the first after an answer begin the next head."""
        self._unset_keepalive_if_required()
        if self._phase in ("deaf", "parting"):
            self._throw_away(data)
            return
        if self._phase == "quiet" and self._idle:
            self._enter("head")
        if self._phase == "head":
            self._bytes += len(data)
        elif self._phase == "body":
            self._besides += len(data)
        try:
            self._parse(data)
        except HttpParserError as error:
            self._refuse(not_http(str(error)))
        if self._phase == "head" and self._bytes > LARGEST_HEAD:
            self._refuse(head_too_large())
        elif self._besides > LARGEST_HEAD:
            self._refuse(trailers_too_large())

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
        self.url = _WITHOUT_PATH.sub(rb"\1/\2", self.url)
        super().on_headers_complete()
        self.cycle.transport = cast("asyncio.Transport", self._ending)
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

    def eof_received(self) -> bool:  # type: ignore[override]  # as asyncio has it, though not uvicorn
        """Answer whoever has said all and may still listen; a stream that has begun ends instead."""
        listens = self._phase in ("quiet", "deaf") and not self._idle
        if not listens or self._answering is None or self._answering.response_started:
            return False
        self.cycle.keep_alive = False
        return True

    def on_response_complete(self) -> None:
        """Go on with the next request; no more are read while others wait, and one begun has its time."""
        super().on_response_complete()
        if self.transport.is_closing():
            return
        if self.pipeline:
            self.flow.pause_reading()
        elif self._phase == "head" and self._bytes:
            self._unset_keepalive_if_required()

    def connection_lost(self, exc: Exception | None) -> None:
        """Tell all who are to be answered, and not only the last, that nobody listens any more."""
        for cycle in (self._answering, *(cycle for cycle, _ in self.pipeline)):
            if cycle is not None:
                _leave_unanswered(cycle)
        super().connection_lost(exc)
        self._ending.close = self.transport.close  # it holds nobody any more

    def look(self) -> None:
        """Give the connection up if its client has been slow for too long."""
        self._looks += 1
        waits = self.flow.write_paused or self.transport.is_closing()
        self._stalled = self._stalled + 1 if waits else 0
        if self._stalled > ANSWER_LOOKS:
            self.transport.abort()
        elif self.transport.is_closing():
            return
        elif self._phase == "parting" and self._looks > PARTING_LOOKS:
            self.transport.close()
        elif self._phase == "head":
            self._look_at_head()
        elif self._phase == "body":
            self._look_at_body()

    def give_up(self) -> None:
        """Refuse whatever is not answered yet, since the service stops, and leave whoever does not listen."""
        if self.flow.write_paused or self._phase == "parting":
            self.transport.abort()
            return
        if self._answering is None or self._answering.response_started:
            return
        for cycle in (self._answering, *(cycle for cycle, _ in self.pipeline)):
            _leave_unanswered(cycle)
        self.pipeline.clear()
        self._enter("deaf")
        self._say(stopping())

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

    def _enter(self, phase: Phase) -> None:
        self._phase, self._looks, self._bytes, self._besides = phase, 0, 0, 0

    def _look_at_head(self) -> None:
        if self.flow.read_paused:
            self._looks = 0  # it is the service that does not read on
        if self._looks <= HEAD_LOOKS:
            return
        if self._bytes:
            self._refuse(too_slow("the head of the request was not finished in time"))
        else:
            self.transport.close()  # opened ahead of need, as browsers do

    def _look_at_body(self) -> None:
        if self.flow.read_paused or self.cycle.waiting_for_100_continue:
            self._enter("body")  # it is the service that does not read on
        elif self._looks > BODY_LOOKS:
            if self._bytes < BODY_BYTES:
                self._refuse(too_slow("the body of the request came too slowly"))
            else:
                self._enter("body")

    def _refuse(self, problem: Problem) -> None:
        """Say what is wrong when all that was asked before is answered, and close."""
        unfinished = self._phase == "body"
        self._enter("deaf")
        if unfinished:
            if self.cycle.response_started:
                self.transport.close()
                return
            self._withdraw(self.cycle)
        self._say(problem)

    def _part(self) -> None:
        """Close after the last answer, which whoever is in the midst of sending would lose: hear them out."""
        if self.transport.is_closing() or self._phase not in ("body", "deaf"):
            self.transport.close()
            return
        self._enter("parting")
        self.pipeline.clear()
        self.transport.write_eof()

    def _throw_away(self, data: bytes) -> None:
        self._bytes += len(data)
        if self._phase == "parting" and self._bytes > PARTING_BYTES:
            self.transport.close()

    def _withdraw(self, cycle: RequestResponseCycle) -> None:
        """Leave the last request unanswered."""
        _leave_unanswered(cycle)
        if cycle is not self._answering:
            self.pipeline.popleft()

    def _say(self, problem: Problem) -> None:
        """Answer with a problem after all other answers, and close."""
        before = self._answering
        self.cycle = RequestResponseCycle(
            scope={"type": "http", "method": "GET", "headers": []},  # type: ignore[typeddict-item]  # no request
            transport=cast("asyncio.Transport", self._ending),
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


def _leave_unanswered(cycle: RequestResponseCycle) -> None:
    cycle.disconnected = True
    cycle.message_event.set()


def _refuse_connect(method: bytes) -> None:
    if method == b"CONNECT":
        raise ValueError("this is no proxy")
