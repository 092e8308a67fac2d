"""Connections are given up when their clients are too slow, and whatever is no HTTP gets a problem, too."""

import hashlib
import http.client
import json
import logging
import re
import socket
import threading
import time
from contextlib import closing, contextmanager
from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.app.planar_arm import description
from tests.app.stubs import StubExecutor
from veritorque.app import logging as journal
from veritorque.app.http import connection
from veritorque.app.http import server as listening
from veritorque.app.http.server import Server
from veritorque.app.http.uvicorn_parts import BodyChunks
from veritorque.app.main import create_app
from veritorque.app.settings import Settings

POLL = b"GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n"
LAST_POLL = POLL[:-2] + b"Connection: close\r\n\r\n"


@contextmanager
def listening_service(directory, executor=None, **settings):
    """Run the service on a free port; gives the server and the port."""
    chosen = Settings(data_dir=directory, port=0, **settings)
    server = Server(create_app(chosen, executor=executor or StubExecutor()), chosen)
    thread = threading.Thread(target=server.run)
    thread.start()
    while not server.started:
        time.sleep(0.01)
    try:
        yield server, server.servers[0].sockets[0].getsockname()[1]
    finally:
        server.should_exit = True
        thread.join()


@pytest.fixture(scope="module")
def patient_port(tmp_path_factory):
    """A service that is as patient as it is meant to be."""
    with listening_service(tmp_path_factory.mktemp("data")) as (_, port):
        yield port


@pytest.fixture
def port(patient_port, monkeypatch):
    """The same service; its patience is a second meanwhile."""
    for name in ("HEAD_TICKS", "BODY_TICKS", "ANSWER_TICKS", "CLOSING_TICKS"):
        monkeypatch.setattr(connection, name, 1)
    return patient_port


def connected(port):
    return socket.create_connection(("127.0.0.1", port), timeout=5.0)


def all_of(link):
    """Read until the service closes; fails if it does not within five seconds."""
    pieces = []
    while piece := link.recv(65536):
        pieces.append(piece)
    return b"".join(pieces)


def answers_of(link, count):
    """Read as many answers as are asked for."""
    reader, answers = link.makefile("rb"), []
    for _ in range(count):
        status, headers = int(reader.readline().split()[1]), http.client.parse_headers(reader)
        body = reader.read(int(headers.get("content-length", 0)))
        answers.append(SimpleNamespace(status=status, headers=headers, body=body))
    return answers


def upload_head(size, *more, chunked=False):
    """Write the head of an upload."""
    framing = b"Transfer-Encoding: chunked\r\n" if chunked else b"Content-Length: %d\r\n" % size
    start = b"POST /v1/logs HTTP/1.1\r\nHost: localhost\r\nContent-Type: text/csv\r\n"
    return b"".join([start, *more, framing, b"\r\n"])


def seconds_until_closed(link, pieces, *, pause=0.0):
    """Send piece by piece until the service has closed, and give how long that took."""
    begun = time.monotonic()
    try:
        for piece in pieces:
            link.sendall(piece)
            time.sleep(pause)
    except (BrokenPipeError, ConnectionResetError):
        return time.monotonic() - begun
    return pytest.fail("the service keeps the connection")


def problem_in(answer, status, kind):
    head, _, body = answer.partition(b"\r\n\r\n")
    assert head.startswith(b"HTTP/1.1 %d " % status), head
    assert b"content-type: application/problem+json" in head.lower()
    assert json.loads(body)["type"] == f"urn:veritorque:problem:{kind}"


@pytest.mark.parametrize("said", [b"G", b"GET /healthz HTTP/1.1\r\nHost: localhost\r\n"])
def test_a_head_that_does_not_end_is_given_up(port, said):
    with connected(port) as link:
        link.sendall(said)
        problem_in(all_of(link), 408, "too-slow")


def test_a_head_that_comes_byte_by_byte_is_given_up_all_the_same(port):
    with connected(port) as link:
        link.sendall(b"GET /healthz HTTP/1.1\r\nX: ")
        assert seconds_until_closed(link, [b"x"] * 500, pause=0.02) < 4.0


def test_a_connection_on_which_nothing_comes_is_closed_without_a_word(port):
    with connected(port) as link:
        assert all_of(link) == b""


def test_empty_lines_do_not_keep_a_connection_open(port):
    with connected(port) as link:
        link.sendall(POLL)
        link.recv(65536)
        assert seconds_until_closed(link, [b"\r\n"] * 200, pause=0.05) < 4.0


def test_a_connection_on_which_nothing_comes_after_a_late_body_is_closed_without_a_word(port):
    with connected(port) as link:
        link.sendall(upload_head(10).replace(b"/v1/logs", b"/nothing"))
        assert answers_of(link, 1)[0].status == 404
        link.sendall(b"0123456789")
        assert all_of(link) == b""


def test_a_body_that_comes_too_slowly_is_given_up(port):
    with connected(port) as link:
        head = b"POST /v1/logs HTTP/1.1\r\nHost: localhost\r\nContent-Type: text/csv\r\n"
        link.sendall(head + b"Content-Length: 100000\r\n\r\ntime,q_1\n")
        problem_in(all_of(link), 408, "too-slow")


def test_a_body_that_comes_steadily_is_waited_for(port):
    content = json.dumps({"name": "x" * 20_000}).encode()
    with connected(port) as link:
        head = b"POST /v1/robots HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
        link.sendall(head + b"Connection: close\r\nContent-Length: %d\r\n\r\n" % len(content))
        for begin in range(0, len(content), 1000):
            link.sendall(content[begin : begin + 1000])
            time.sleep(0.1)  # two seconds in all, twice the patience
        problem_in(all_of(link), 422, "robot")


def test_a_client_that_waits_for_leave_to_send_is_not_slow(port):
    with connected(port) as link:
        head = (
            b"POST /v1/logs HTTP/1.1\r\nHost: localhost\r\nContent-Type: text/csv\r\nExpect: 100-continue\r\n"
        )
        link.sendall(head + b"Content-Length: 9\r\n\r\n")
        assert link.recv(100).startswith(b"HTTP/1.1 100 ")
        link.sendall(b"time,q_1\n")
        assert link.recv(65536).startswith(b"HTTP/1.1 422 ")


@pytest.mark.parametrize(
    "said",
    [
        b"hello\r\n\r\n",
        b"GET /healthz HTTP/9.9\r\n\r\n",
        b"GET /\xff HTTP/1.1\r\nHost: localhost\r\n\r\n",
        b"CONNECT localhost:80 HTTP/1.1\r\nHost: localhost\r\n\r\n",
        b"GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\nTransfer-Encoding: chunked\r\n\r\n",
        b"GET /healthz HTTP/1.1\r\nHost: localhost\r\nBad Header: 1\r\n\r\n",
        b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03",
    ],
)
def test_what_is_not_http_gets_a_problem(port, said):
    with connected(port) as link:
        link.sendall(said)
        problem_in(all_of(link), 400, "bad-request")


OFFERS = [
    b"Connection: Upgrade, HTTP2-Settings\r\nUpgrade: h2c\r\nHTTP2-Settings: AAMAAABkAAQCAAAAAAIAAAAA\r\n",
    b"connection: upgrade\r\nupgrade: websocket\r\n",
]


@pytest.mark.parametrize("offer", OFFERS)
@pytest.mark.parametrize("chunked", [False, True])
@pytest.mark.parametrize("pause", [0.0, 0.1])
def test_a_body_is_read_though_its_client_offers_another_protocol(port, log_bytes, offer, chunked, pause):
    head = upload_head(len(log_bytes), offer, chunked=chunked)
    body = b"%x\r\n%b\r\n0\r\n\r\n" % (len(log_bytes), log_bytes) if chunked else log_bytes
    with connected(port) as link:
        link.sendall(head[:-9])
        time.sleep(pause)
        link.sendall(head[-9:] + body[:999])
        time.sleep(pause)
        link.sendall(body[999:] + POLL)
        first, second = answers_of(link, 2)
    assert first.status == 201
    assert json.loads(first.body)["sha256"] == hashlib.sha256(log_bytes).hexdigest()
    assert second.status == 200


def test_a_body_is_never_read_as_a_request(port):
    with connected(port) as link:
        link.sendall(upload_head(len(POLL), b"Connection: Upgrade\r\nUpgrade: other\r\n"))
        time.sleep(0.1)
        link.sendall(POLL + LAST_POLL)
        assert [answer.status for answer in answers_of(link, 2)] == [422, 200]
        assert all_of(link) == b""


def test_requests_after_many_offers_of_another_protocol_are_all_answered(port):
    offer = POLL[:-2] + OFFERS[0] + b"\r\n"
    with connected(port) as link:
        link.sendall(offer * 1500 + LAST_POLL)
        assert all_of(link).count(b"HTTP/1.1 200 ") == 1501


TRAILERS = [
    b"Host: other.example",
    b"Sec-Fetch-Site: cross-site",
    b"Content-Digest: sha-256=:AAAA:",
    b"Content-Type: image/png",
    b"Expect: 100-continue",
]


def test_what_follows_a_body_is_no_part_of_its_head(port, log_bytes):
    body = b"%x\r\n%b\r\n0\r\n" % (len(log_bytes), log_bytes)
    with connected(port) as link:
        for trailer in TRAILERS:
            link.sendall(upload_head(0, chunked=True) + body + trailer + b"\r\n\r\n")
            assert answers_of(link, 1)[0].status == 201, trailer


@pytest.mark.parametrize(
    ("start", "piece"), [(b"0\r\n", b"a:b\r\n" * 10_000), (b"0\r\nX: ", b"x" * 65536), (b"1;", b"x" * 65536)]
)
def test_what_goes_with_a_body_is_refused_before_it_fills_the_memory(patient_port, start, piece, monkeypatch):
    monkeypatch.setattr(connection, "CLOSING_BYTES", 1_000_000)
    head = upload_head(0, chunked=True)
    with connected(patient_port) as link:
        link.sendall(head + start)
        assert seconds_until_closed(link, [piece] * 1000) < 4.0
    with connected(patient_port) as link:
        link.sendall(head.replace(b"/v1/logs", b"/nothing") + start)
        assert answers_of(link, 1)[0].status == 404
        assert seconds_until_closed(link, [piece] * 1000) < 4.0


def test_whoever_sends_too_much_with_a_body_is_told(patient_port):
    with connected(patient_port) as link:
        link.sendall(upload_head(0, chunked=True) + b"0\r\n")
        time.sleep(0.1)
        for _ in range(100):
            link.sendall(b"X: " + b"x" * 9_995 + b"\r\n")
        problem_in(all_of(link), 431, "head-too-large")


def test_a_body_in_small_chunks_is_taken(port, log_bytes):
    chunks = b"".join(b"1\r\n%c\r\n" % byte for byte in log_bytes)
    with connected(port) as link:
        link.sendall(upload_head(0, chunked=True) + chunks + b"0\r\n\r\n")
        assert answers_of(link, 1)[0].status == 201


GARBAGE = b"\x01garbage\r\n\r\n"


def posted(port, path, content, kind):
    """Send a body, and give the id of what was made of it."""
    with closing(http.client.HTTPConnection("127.0.0.1", port)) as link:
        link.request("POST", path, content, {"Content-Type": kind})
        return json.load(link.getresponse())["id"]


def job_request(port, log_bytes, wait):
    """Make a robot and a log, and write the request for a job that waits for its end."""
    robot = posted(port, "/v1/robots", json.dumps(description()).encode(), "application/json")
    log = posted(port, "/v1/logs", log_bytes, "text/csv")
    content = json.dumps({"kind": "identify", "robot": robot, "logs": [log]}).encode()
    head = b"POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
    return head + b"Prefer: wait=%d\r\nContent-Length: %d\r\n\r\n" % (wait, len(content)) + content


@pytest.mark.parametrize(
    ("more", "statuses"),
    [
        (GARBAGE, [202, 400]),
        (POLL + GARBAGE, [202, 200, 400]),
        (POLL[:-10], [202, 408]),
        (upload_head(100) + b"too slow", [202, 408]),
        (upload_head(0, chunked=True) + GARBAGE, [202, 400]),
        (POLL + upload_head(0, chunked=True) + GARBAGE, [202, 200, 400]),
    ],
)
def test_what_was_asked_before_is_answered_before_a_refusal(port, log_bytes, more, statuses):
    request = job_request(port, log_bytes, wait=2)
    with connected(port) as link:
        link.sendall(request + more)
        assert [answer.status for answer in answers_of(link, len(statuses))] == statuses
        assert all_of(link) == b""


def test_no_refusal_stands_in_the_midst_of_a_stream(tmp_path, log_bytes):
    executor = StubExecutor()
    with listening_service(tmp_path, executor) as (_, port):
        request = job_request(port, log_bytes, wait=0)
        with connected(port) as link:
            link.sendall(request)
            job = json.loads(answers_of(link, 1)[0].body)["id"].encode()
            link.sendall(POLL.replace(b"/healthz", b"/v1/jobs/%b/events" % job) + POLL + GARBAGE)
            time.sleep(0.2)
            executor.release.set()
            stream, _, rest = all_of(link).partition(b"\r\n0\r\n\r\n")
    assert b"event: end" in stream
    assert stream.count(b"HTTP/1.1") == 1
    assert re.findall(rb"HTTP/1.1 (\d+)", rest) == [b"200", b"400"]


def test_an_upload_that_does_not_end_before_the_service_stops_is_told(
    tmp_path, log_bytes, caplog, monkeypatch
):
    monkeypatch.setattr(listening, "REFUSE_AFTER_S", 2.0)
    upload = upload_head(len(log_bytes)) + log_bytes
    with listening_service(tmp_path) as (server, port), connected(port) as slow, connected(port) as quick:
        slow.sendall(upload[:-10])
        quick.sendall(upload[:-10])
        time.sleep(0.1)
        server.should_exit = True
        time.sleep(0.2)
        quick.sendall(upload[-10:])
        assert answers_of(quick, 1)[0].status == 201
        problem_in(all_of(slow), 503, "stopping")
    assert [record for record in caplog.records if record.levelname == "ERROR"] == []


def test_whoever_has_said_all_is_answered(port, log_bytes):
    request = job_request(port, log_bytes, wait=1)
    for said, statuses in (
        (POLL, [200]),
        (upload_head(len(log_bytes)) + log_bytes, [201]),
        (request, [202]),
        (request + POLL, [202, 200]),
        (request + GARBAGE, [202, 400]),
    ):
        with connected(port) as link:
            link.sendall(said)
            link.shutdown(socket.SHUT_WR)
            assert [answer.status for answer in answers_of(link, len(statuses))] == statuses
            assert all_of(link) == b""


def test_whoever_sends_on_hears_why_the_rest_is_not_taken(tmp_path):
    with listening_service(tmp_path, max_upload_bytes=100_000) as (_, port):
        for framing in ({"Content-Length": "30000000"}, {"Transfer-Encoding": "chunked"}):
            with closing(http.client.HTTPConnection("127.0.0.1", port, timeout=5.0)) as link:
                body, chunked = iter([bytes(100_000)] * 300), "Transfer-Encoding" in framing
                headers = {"Content-Type": "text/csv"} | framing
                link.request("POST", "/v1/logs", body, headers, encode_chunked=chunked)
                answer = link.getresponse()
                assert json.load(answer)["type"] == "urn:veritorque:problem:too-large"
                assert answer.headers["connection"] == "close"


@pytest.mark.parametrize("length", [2**31 + 1, 10**19, 2**64 - 1])
def test_a_length_that_is_too_large_is_refused_at_once(patient_port, length):
    with connected(patient_port) as link:
        link.sendall(upload_head(length))
        assert answers_of(link, 1)[0].status == 413


def test_a_coding_that_nobody_undoes_is_refused(port):
    head = upload_head(0, chunked=True).replace(b"chunked", b"gzip, chunked")
    with connected(port) as link:
        link.sendall(head + b"1\r\nx\r\n0\r\n\r\n" + LAST_POLL)
        refused, after = answers_of(link, 2)
    assert (refused.status, after.status) == (400, 200)
    assert json.loads(refused.body)["evidence"] == {"transfer_encoding": "gzip, chunked"}


@pytest.mark.parametrize("address", [b"http://localhost", b"http://localhost:80?x=1", b"http://localhost/"])
def test_an_address_may_be_written_in_full(patient_port, address):
    with connected(patient_port) as link:
        link.sendall(LAST_POLL.replace(b"/healthz", address))
        assert answers_of(link, 1)[0].status == 200
    with connected(patient_port) as link:
        link.sendall(LAST_POLL.replace(b"/healthz", b"http://localhost/healthz"))
        assert json.loads(answers_of(link, 1)[0].body) == {"status": "alive"}


def test_whoever_never_ends_is_not_heard_out(port, monkeypatch):
    head = upload_head(10**12)
    with connected(port) as link:
        link.sendall(head)
        assert answers_of(link, 1)[0].status == 413
        assert seconds_until_closed(link, [b"x"] * 500, pause=0.01) < 3.0
    monkeypatch.setattr(connection, "CLOSING_BYTES", 1_000_000)
    monkeypatch.setattr(connection, "CLOSING_TICKS", 100)
    with connected(port) as link:
        link.sendall(head)
        assert seconds_until_closed(link, [b"x" * 65536] * 1000) < 3.0


def test_whoever_breaks_off_is_not_waited_for(port, log_bytes):
    upload = upload_head(len(log_bytes)) + log_bytes
    for said in (b"", upload[:30], upload[:-10], POLL[:-1]):
        with connected(port) as link:
            link.sendall(said)
            link.shutdown(socket.SHUT_WR)
            link.settimeout(0.4)
            assert all_of(link) == b""


def test_a_client_that_goes_away_before_its_answers_is_no_mistake_of_the_service(port, log_bytes, caplog):
    request = job_request(port, log_bytes, wait=1)
    for more in (b"", POLL, POLL * 3):
        with connected(port) as link:
            link.sendall(request + more)
            time.sleep(0.05)
    time.sleep(1.2)
    assert [record for record in caplog.records if record.levelname == "ERROR"] == []


def test_a_document_that_does_not_come_is_no_mistake_of_the_service(port, caplog):
    start = b"POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
    for rest in (b"Content-Length: 100\r\n\r\n{", b"Transfer-Encoding: chunked\r\n\r\nzz\r\n"):
        with closing(connected(port)) as link:
            link.sendall(start + rest)
            time.sleep(0.1)
    with closing(connected(port)) as link:
        link.sendall(LAST_POLL)
        all_of(link)
    assert [line for line in caplog.records if line.levelno >= logging.ERROR] == []


def test_no_more_requests_are_read_while_others_wait(port, monkeypatch):
    """As many as one read of the socket holds may wait, and no more come in with every answer."""
    most, honest = [0], connection.TimedConnection.on_headers_complete

    def counted(self):
        honest(self)
        most[0] = max(most[0], len(self.pipeline))

    monkeypatch.setattr(connection.TimedConnection, "on_headers_complete", counted)
    poll = POLL[:-2] + b"X: " + b"x" * 400 + b"\r\n\r\n"
    with closing(connected(port)) as link:
        asked = 2_000  # several times what may wait, in bytes
        sender = threading.Thread(target=link.sendall, args=(poll * asked + LAST_POLL,))
        sender.start()
        assert all_of(link).count(b"HTTP/1.1 200") == asked + 1
        sender.join()
    assert most[0] <= 2 * 256 * 1024 // len(poll)


def test_a_head_that_has_begun_beside_an_answer_has_as_long_as_any(port, monkeypatch):
    monkeypatch.setattr(
        connection, "HEAD_TICKS", 11
    )  # longer than a connection is kept on which nothing comes
    with closing(connected(port)) as link:
        link.settimeout(10.0)
        link.sendall(POLL + POLL[:9])
        assert all_of(link).count(b"HTTP/1.1 408") == 1


def test_a_head_without_end_is_refused_before_it_fills_the_memory(port, monkeypatch):
    monkeypatch.setattr(connection, "CLOSING_BYTES", 1_000_000)
    with connected(port) as link:
        link.sendall(b"GET /healthz HTTP/1.1\r\nHost: localhost\r\nX: ")
        assert seconds_until_closed(link, [b"x" * 65536] * 1000) < 4.0
    with connected(port) as link:
        link.sendall(b"GET /healthz HTTP/1.1\r\nHost: localhost\r\nX: " + b"x" * 140_000)
        problem_in(all_of(link), 431, "head-too-large")


@pytest.mark.parametrize("kilobytes", [200, 300, 400])
def test_a_head_that_begins_in_the_midst_of_much_else_is_not_taken_for_large(
    patient_port, log_bytes, kilobytes
):
    long = log_bytes.rstrip() + (b"\n#" + b"x" * 998) * kilobytes
    asked = [upload_head(len(body)) + body for body in (log_bytes, long)]
    with connected(patient_port) as link:
        link.sendall(asked[0] + POLL + asked[1] + LAST_POLL[:-10])
        time.sleep(0.3)
        link.sendall(LAST_POLL[-10:])
        assert [answer.status for answer in answers_of(link, 4)] == [201, 200, 201, 200]


def test_a_client_that_takes_nothing_is_given_up(port):
    with socket.socket() as link:
        link.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        link.settimeout(5.0)
        link.connect(("127.0.0.1", port))
        request = b"GET /static/swagger-ui-bundle.js HTTP/1.1\r\nHost: localhost\r\n\r\n"
        assert seconds_until_closed(link, [request] * 100, pause=0.1) < 6.0


def test_many_that_stop_in_the_middle_do_not_hold_up_the_others(port):
    links = [connected(port) for _ in range(100)]
    try:
        for link in links:
            link.sendall(b"GET /healthz HTTP/1.1\r\nHost:")
        with connected(port) as other:
            for _ in range(20):
                other.sendall(POLL)
                assert [answer.status for answer in answers_of(other, 1)] == [200]
        assert all(all_of(link).startswith(b"HTTP/1.1 408 ") for link in links)
    finally:
        for link in links:
            link.close()


def test_all_that_the_server_says_is_json(tmp_path, capsys):
    root = logging.getLogger()
    before = root.handlers, root.level
    try:
        journal.configure_logging(Settings(data_dir=tmp_path))
        with listening_service(tmp_path):
            pass
    finally:
        root.handlers, root.level = before
    lines = [json.loads(line) for line in capsys.readouterr().err.splitlines()]
    assert "Shutting down" in [line["event"] for line in lines if line["logger"] == "uvicorn.error"]


@given(st.lists(st.binary(max_size=9)))
def test_a_body_in_pieces_is_the_body(pieces):
    body = BodyChunks()
    for piece in pieces:
        body += piece
    assert (len(body), bytes(body)) == (len(b"".join(pieces)), b"".join(pieces))


def test_a_body_in_one_piece_is_not_copied():
    body, piece = BodyChunks(), bytes(1000)
    body += piece
    assert bytes(body) is piece
