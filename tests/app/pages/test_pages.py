import hashlib
import json
import re
from html import unescape
from html.parser import HTMLParser
from pathlib import Path
from posixpath import dirname, join, normpath

import pytest

from tests.app.conftest import assert_problem, service
from veritorque.app.kinds.diagnose import HIDDEN_LOG_ID
from veritorque.app.kinds.identify import EXAMPLE_LOG_ID
from veritorque.app.kinds.registry import KINDS
from veritorque.app.pages.files import STATIC
from veritorque.app.store.logs import log_id
from veritorque.core.estimate.methods.registry import ESTIMATORS
from veritorque.core.log.channels import CHANNELS


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


PAGES = ["/", "/new", "/studies/job-1", "/compare", "/docs"]


@pytest.fixture(scope="module")
def guarded(tmp_path_factory):
    """A service that other machines can reach: whoever wants data needs a key."""
    with service(tmp_path_factory.mktemp("guarded"), host="0.0.0.0") as client:  # noqa: S104 - with keys
        yield client


@pytest.mark.parametrize("path", PAGES)
def test_a_page_needs_nothing_from_elsewhere_and_every_address_on_it_answers(client, path):
    page = client.get(path)
    addresses = Addresses(page.text)
    assert page.headers["content-type"].startswith("text/html")
    assert "default-src 'none'" in page.headers["content-security-policy"]
    assert addresses.inline == []
    for address in addresses.found:
        assert address.startswith(("/", "#")), address
        if address.startswith("/"):
            assert client.get(address.split("#")[0]).status_code in {200, 503}, address


BROWSER = "text/html,application/xhtml+xml,application/xml;q=0.9,*/*;q=0.8"


def test_the_form_that_maps_columns_gets_the_table_of_channels_with_its_page(client):
    content = re.search(r'<meta name="channels" content="(.*?)">', client.get("/new").text)[1]
    table = json.loads(unescape(content))["channels"]
    assert list(table) == list(CHANNELS)
    for name, entry in table.items():
        assert entry["units"] == [unit.name for unit in CHANNELS[name].quantity.units]


def test_the_form_that_starts_an_analysis_gets_every_kind_of_job_and_every_estimator(client):
    content = re.search(r'<meta name="analyses" content="(.*?)">', client.get("/new").text)[1]
    table = json.loads(unescape(content))
    assert [kind["name"] for kind in table["kinds"]] == list(KINDS)
    assert [estimator["name"] for estimator in table["estimators"]] == list(ESTIMATORS)
    assert all(entry["title"] for entry in (*table["kinds"], *table["estimators"]))


@pytest.mark.parametrize("path", ["/studies", "/studies/a/b", "/nothing", "/v1/jobs/job-none/report"])
def test_a_browser_at_an_address_that_is_not_there_is_shown_a_page_that_leads_on(client, path):
    page = client.get(path, headers={"Accept": BROWSER})
    assert page.status_code == 404
    assert page.headers["content-type"].startswith("text/html")
    assert "default-src 'none'" in page.headers["content-security-policy"]
    assert "Page not found" in page.text
    addresses = Addresses(page.text)
    assert addresses.inline == []
    assert "/" in addresses.found
    assert all(client.get(one).status_code in {200, 503} for one in addresses.found if one.startswith("/"))


@pytest.mark.parametrize("accept", ["*/*", "application/json", "application/problem+json, text/html;q=0.5"])
def test_a_program_at_an_address_that_is_not_there_is_told_a_problem(client, accept):
    for path in ("/studies", "/v1/jobs/job-none"):
        assert_problem(client.get(path, headers={"Accept": accept}), 404, "not-found")
    assert_problem(client.delete("/v1/jobs/job-none", headers={"Accept": BROWSER}), 404, "not-found")


@pytest.mark.parametrize("name", STATIC)
def test_a_file_of_the_pages_has_its_own_media_type(client, name):
    answer = client.get(f"/static/{name}")
    assert answer.status_code == 200
    assert answer.headers["content-type"].startswith(STATIC[name].media_type)
    assert answer.headers["x-content-type-options"] == "nosniff"


@pytest.mark.parametrize("name", ["../settings.py", "%2e%2e%2fsettings.py", "start.html", "..\\settings.py"])
def test_no_other_file_is_given_out(client, name):
    assert_problem(client.get(f"/static/{name}"), 404, "not-found")


def test_there_is_no_second_documentation(client):
    assert_problem(client.get("/redoc"), 404, "not-found")


def test_the_documentation_shows_the_contract_of_this_service(client):
    assert re.search(r'url: "(.*?)"', client.get("/static/docs.js").text)[1] == "/openapi.json"
    assert client.get("/openapi.json").json() == json.loads(json.dumps(client.app.openapi()))


@pytest.mark.parametrize("path", PAGES)
def test_a_page_holds_no_data_and_needs_no_key(guarded, path):
    assert_problem(guarded.get("/v1/jobs"), 401, "no-key")
    assert guarded.get(path).status_code == 200
    assert guarded.get("/static/style.css").status_code == 200


@pytest.mark.parametrize("path", PAGES[:-1])
def test_a_page_runs_and_styles_nothing_but_files_of_its_own(client, path):
    policy = client.get(path).headers["content-security-policy"]
    assert "unsafe" not in policy
    assert "connect-src 'self'" in policy
    assert not re.search(r" (style|on[a-z]+)=", client.get(path).text)


@pytest.mark.parametrize("name", [name for name in STATIC if name.endswith(".js")])
def test_a_module_asks_only_for_modules_that_are_there(client, name):
    text = client.get(f"/static/{name}").text
    wanted = re.findall(r'^import [^;]*? from "(\.[^"]+)";', text, re.MULTILINE)
    assert {normpath(join(dirname(name), module)) for module in wanted} <= set(STATIC)
    assert text.count(' from ".') == len(wanted)


def test_a_browser_that_has_a_file_is_told_so(client):
    first = client.get("/static/style.css")
    known = {"If-None-Match": first.headers["etag"]}
    again = client.get("/static/style.css", headers=known)
    assert (again.status_code, again.content) == (304, b"")
    assert client.get("/static/drawing/plot.js", headers=known).status_code == 200


def test_a_file_travels_packed_to_who_can_unpack_it(client):
    plain = client.get("/static/swagger-ui-bundle.js", headers={"Accept-Encoding": "identity"})
    packed = client.get("/static/swagger-ui-bundle.js", headers={"Accept-Encoding": "gzip"})
    assert packed.content == plain.content
    assert int(packed.headers["content-length"]) < 0.4 * int(plain.headers["content-length"])
    assert packed.headers["etag"] != plain.headers["etag"]


@pytest.mark.parametrize("path", PAGES)
def test_a_page_trusts_no_text_of_the_address(client, path):
    assert_problem(client.get(path, headers={"Host": "<script>alert(1)</script>"}), 421, "wrong-host")
    assert "alert(1)" not in client.get("/studies/<script>alert(1)<").text


@pytest.mark.parametrize(
    ("served", "name", "identity"),
    [
        ("example-log.csv", "log.csv", EXAMPLE_LOG_ID),
        ("example-hidden-log.csv", "hidden_log.csv", HIDDEN_LOG_ID),
    ],
)
def test_the_example_of_the_start_page_is_the_log_that_ships(client, served, name, identity):
    content = client.get(f"/static/{served}").content
    assert log_id(sha256=hashlib.sha256(content).hexdigest(), name=name, mapping=None) == identity


@pytest.mark.parametrize("name", ["log.csv", "hidden_log.csv"])
def test_the_image_takes_the_example_along(name):
    docker = Path(__file__).parents[3] / "docker"
    assert (
        f"examples/yumi/{name}"
        in re.search(r"^COPY examples.*$", (docker / "Dockerfile").read_text(), re.MULTILINE)[0]
    )
    assert f"!examples/yumi/{name}" in (docker / "Dockerfile.dockerignore").read_text().split()
