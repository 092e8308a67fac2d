import json
import re
from html.parser import HTMLParser

import pytest

from app.routes.pages import FILES
from tests.app.conftest import assert_problem, service
from tests.app.stubs import StubExecutor
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


def test_the_start_page_lists_the_latest_jobs_and_trusts_no_text(tmp_path, log_bytes):
    executor = StubExecutor()
    executor.release.set()
    with service(tmp_path, executor) as client:
        empty = client.get("/", headers={"Host": "<script>alert(1)</script>"}).text
        assert "None yet." in empty
        assert "<script>" not in empty
        job = client.post("/v1/jobs", json=asked(client, log_bytes), headers={"Prefer": "wait=10"}).json()
        page = client.get("/").text
        assert job["links"]["results"] in page
        assert "successful" in page
