"""Only requests that are meant for the service are answered, and no page of another site can make them."""

import pytest

from tests.app.conftest import assert_problem, service


@pytest.mark.parametrize(
    "host",
    ["testserver", "localhost", "LOCALHOST:8000", "127.0.0.1", "127.0.0.1:8000", "[::1]:8000", "192.168.1.5"],
)
def test_the_service_answers_to_its_names_and_to_addresses(client, host):
    assert client.get("/healthz", headers={"Host": host}).status_code == 200


@pytest.mark.parametrize(
    "host",
    [
        "evil.example",
        "localhost.evil.example",
        "127.0.0.1.evil.example",
        "localhost@evil.example",
        "",
        ":80",
        "localhost:port",
        "[::1",
        "localhost/path",
        "evil.example#localhost",
        "local host",
    ],
)
def test_a_name_that_is_not_the_services_is_refused(client, host):
    assert_problem(client.get("/healthz", headers={"Host": host}), 421, "wrong-host")


def test_an_operator_can_give_the_service_names(tmp_path):
    with service(tmp_path, hosts=("robots.lab", "testserver")) as client:
        assert client.get("/healthz", headers={"Host": "Robots.Lab.:443"}).status_code == 200
        assert_problem(client.get("/healthz", headers={"Host": "other.lab"}), 421, "wrong-host")


@pytest.mark.parametrize(
    "headers",
    [
        {"Sec-Fetch-Site": "cross-site"},
        {"Sec-Fetch-Site": "same-site"},
        {"Origin": "https://evil.example"},
        {"Origin": "http://localhost:3000"},
        {"Origin": "null"},
    ],
)
def test_a_page_of_another_site_can_change_nothing(client, headers):
    assert_problem(client.post("/v1/jobs", json={}, headers=headers), 403, "other-site")
    assert_problem(client.delete("/v1/jobs/none", headers=headers), 403, "other-site")
    answer = client.get("/v1/robots", headers=headers)
    assert answer.status_code == 200
    assert not [name for name in answer.headers if name.startswith("access-control")]


@pytest.mark.parametrize(
    "headers",
    [{"Sec-Fetch-Site": "same-origin"}, {"Sec-Fetch-Site": "none"}, {"Origin": "http://testserver"}],
)
def test_the_services_own_pages_and_programs_can(client, headers):
    assert_problem(client.post("/v1/jobs", json={}, headers=headers), 422, "request")


def test_a_preflight_is_refused_and_names_no_origin(client):
    asked = {"Origin": "https://evil.example", "Access-Control-Request-Method": "POST"}
    answer = client.options("/v1/jobs", headers=asked)
    assert_problem(answer, 405, "method-not-allowed")
    assert not [name for name in answer.headers if name.startswith("access-control")]


@pytest.mark.parametrize("path", ["/", "/docs", "/healthz", "/v1/robots", "/v1/jobs/none", "/nowhere"])
def test_every_answer_says_what_a_browser_may_do_with_it(client, path):
    headers = client.get(path).headers
    policy = headers["content-security-policy"]
    assert "default-src 'none'" in policy
    assert "frame-ancestors 'none'" in policy
    assert "script-src 'unsafe" not in policy
    assert headers["x-content-type-options"] == "nosniff"
    assert headers["referrer-policy"] == "no-referrer"
    assert headers["cross-origin-resource-policy"] == "same-origin"
    assert headers.get_list("cache-control") in (["no-store"], ["max-age=3600"])
