import contextlib
import json
import re
from datetime import UTC, datetime
from html.parser import HTMLParser

import pytest
from app.pages.latest import job_rows

from app.routes.pages import FILES
from app.store.records import JobRecord, JobRequestRecord
from tests.app.conftest import assert_problem, service
from tests.app.planar_arm import description
from tests.app.stubs import StubExecutor, failing
from tests.app.test_jobs import asked


class Addresses(HTMLParser):
    """Collect what a page loads or leads to, and the scripts that stand in it."""

    def __init__(self, text):
        super().__init__()
        self.found, self.inline, self._script = [], [], False
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.found += [value for name, value in attrs if name in {"href", "src"}]
        self._script = tag == "script"

    def handle_data(self, data):
        if self._script and data.strip():
            self.inline.append(data)

    def handle_endtag(self, tag):
        self._script = False


class EmptyCatalogue:
    """Know no robot and no log, as if all had been deleted."""

    def find_robot(self, identity):
        return None

    def find_log(self, identity):
        return None


@pytest.mark.parametrize("path", ["/", "/docs"])
def test_a_page_needs_nothing_from_elsewhere_and_every_address_on_it_answers(client, path):
    page = client.get(path)
    addresses = Addresses(page.text)
    assert page.headers["content-type"].startswith("text/html")
    assert "default-src 'none'" in page.headers["content-security-policy"]
    assert addresses.inline == []
    for address in addresses.found:
        assert address.startswith(("/", "data:,")), address
        if address.startswith("/"):
            assert client.get(address.split("#")[0]).status_code in {200, 503}, address


@pytest.mark.parametrize("name", FILES)
def test_a_file_of_the_pages_has_its_own_media_type(client, name):
    answer = client.get(f"/static/{name}")
    assert answer.status_code == 200
    assert answer.headers["content-type"].startswith(FILES[name][1])
    assert answer.headers["x-content-type-options"] == "nosniff"


@pytest.mark.parametrize("name", ["../settings.py", "%2e%2e%2fsettings.py", "start.html", "..\\settings.py"])
def test_no_other_file_is_given_out(client, name):
    assert_problem(client.get(f"/static/{name}"), 404, "not-found")


def test_there_is_no_second_documentation(client):
    assert_problem(client.get("/redoc"), 404, "not-found")


def test_the_documentation_shows_the_contract_of_this_service(client):
    assert re.search(r'url: "(.*?)"', client.get("/static/docs.js").text)[1] == "/openapi.json"
    assert client.get("/openapi.json").json() == json.loads(json.dumps(client.app.openapi()))


@contextlib.contextmanager
def finished(directory, log_bytes, executor):
    """Give a service and its one finished job, whose outcome is the executor's."""
    executor.release.set()
    with service(directory, executor) as client:
        yield (
            client,
            client.post("/v1/jobs", json=asked(client, log_bytes), headers={"Prefer": "wait=10"}).json(),
        )


def test_the_start_page_links_a_job_to_its_robot_its_logs_and_its_result(tmp_path, log_bytes):
    with finished(tmp_path, log_bytes, StubExecutor()) as (client, job):
        page = client.get("/").text
        found = Addresses(page).found
        assert {f"/v1/robots/{job['robot']}", f"/v1/logs/{job['logs'][0]}"} < set(found)
        assert {job["links"]["self"], job["links"]["results"]} < set(found)
        assert "successful" in page
        assert re.search(r">\d+ s ago</time>", page)
        assert all(client.get(address).status_code == 200 for address in found if job["id"] in address)


def test_the_start_page_says_why_a_job_failed_and_links_to_the_problem(tmp_path, log_bytes):
    with finished(tmp_path, log_bytes, failing()) as (client, job):
        page = client.get("/").text
        (link, cause) = re.search(r'<a href="([^"]*)">problem</a>: ([^<]*)', page).groups()
        assert client.get(link).json()["problem"]["cause"] == cause == "the motion is too slow"
        assert f"/v1/jobs/{job['id']}/results" not in Addresses(page).found


def test_the_start_page_does_not_link_to_what_was_deleted(tmp_path, log_bytes):
    with finished(tmp_path, log_bytes, StubExecutor()) as (client, job):
        gone = [f"/v1/robots/{job['robot']}", f"/v1/logs/{job['logs'][0]}"]
        assert [client.delete(path).status_code for path in gone] == [204, 204]
        page = client.get("/").text
        assert not set(gone) & set(Addresses(page).found)
        assert job["robot"] in page


def test_the_start_page_trusts_no_text(tmp_path, log_bytes):
    executor = failing(cause="<script>alert(1)</script>")
    executor.release.set()
    with service(tmp_path, executor) as client:
        assert_problem(client.get("/", headers={"Host": "<script>alert(1)</script>"}), 421, "wrong-host")
        assert "None yet." in client.get("/").text
        robot = description() | {"name": "<script>alert(2)</script>"}
        form = {
            "robot": (None, json.dumps(robot)),
            "log": ("<script>alert(3)<script>.csv", log_bytes, "text/csv"),
        }
        client.post("/v1/identify", files=form)
        page = client.get("/").text
        assert "<script" not in page
        assert page.count("&lt;script&gt;") == 4


def test_an_age_is_counted_from_the_request_to_now():
    now = datetime(2026, 1, 31, 12, tzinfo=UTC)
    job = JobRecord(
        tenant="local",
        id="job-1",
        sequence=1,
        request=JobRequestRecord("identify", "yumi", ("a", "b", "c", "d", "e"), {}),
        trace=None,
        state="running",
        stage="estimate",
        fraction=0.5,
        attempts=1,
        token=1,
        version=2,
        problem=None,
        result_sha256=None,
        created_at="2026-01-31T10:30:00.000+00:00",
        started_at=None,
        finished_at=None,
    )
    row = job_rows([job], EmptyCatalogue(), now=now)
    assert ">1 h ago<" in row
    assert "estimate 50%" in row
    assert "a, b, c and 2 more" in row
