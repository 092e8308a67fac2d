"""Keys over HTTP: who carries none is refused, and who carries one reaches what is the tenant's alone."""

import pytest

from tests.app.conftest import assert_problem, service
from tests.app.http.test_contract import PROMISED
from tests.app.planar_arm import csv_log, description
from tests.app.stubs import StubExecutor
from veritorque.app.store.keys import KeyStore

CSV = {"Content-Type": "text/csv"}
NAMES = {"robot_id": "yumi", "log_id": "none", "job_id": "none", "artifact": "parameters.csv"}
OPEN = {"/healthz", "/readyz", "/version"}


@pytest.fixture(scope="module")
def guarded(tmp_path_factory):
    """A service that other machines can reach."""
    executor = StubExecutor()
    executor.release.set()
    with service(tmp_path_factory.mktemp("data"), executor, host="0.0.0.0") as client:  # noqa: S104  (not listened on)
        yield client


@pytest.fixture
def made(guarded):
    """Make keys, each given as the header that carries it."""
    keys = KeyStore(guarded.app.state.services.store.database)

    def make(tenant, *scopes):
        _, secret = keys.create(tenant=tenant, name=tenant, scopes=scopes or ("read", "write"))
        guarded.app.state.services.keys._until = 0.0  # as if the seconds had passed
        return {"Authorization": f"Bearer {secret}"}

    return make


@pytest.mark.parametrize(
    ("path", "method"), [(path, method) for path in sorted(PROMISED) for method in sorted(PROMISED[path])]
)
def test_every_resource_but_the_operators_needs_a_key(guarded, path, method):
    answer = guarded.request(method, path.format(**NAMES))
    if path in OPEN:
        assert answer.status_code in {200, 503}
    else:
        assert_problem(answer, 401, "no-key")
        assert answer.headers["www-authenticate"].startswith("Bearer ")


@pytest.mark.parametrize(
    "given", ["Bearer vt_wrong", "Bearer ", "Basic dXNlcjpwYXNz", "vt_wrong", "Bearer é"]
)
def test_what_is_no_key_of_ours_is_refused(guarded, given):
    headers = {"Authorization": given.encode("latin-1")}
    assert_problem(guarded.get("/v1/jobs", headers=headers), 401, "no-key")


def test_a_key_that_may_read_does_not_write(guarded, made):
    reader = made("lab", "read")
    assert guarded.get("/v1/robots", headers=reader).status_code == 200
    problem = assert_problem(guarded.post("/v1/robots", json=description(), headers=reader), 403, "no-scope")
    assert problem["evidence"] == {"needed": "write", "scopes": ["read"]}


def test_what_belongs_to_a_tenant_is_not_there_for_another(guarded, made):
    mine, other = made("mine"), made("other")
    robot = guarded.post("/v1/robots", json=description(), headers=mine).json()["id"]
    log = guarded.post("/v1/logs", content=csv_log(seconds=4.0), headers=mine | CSV).json()["id"]
    asked = {"kind": "identify", "robot": robot, "logs": [log], "options": {}}
    job = guarded.post("/v1/jobs", json=asked, headers=mine | {"Prefer": "wait=10"}).json()
    paths = [f"/v1/robots/{robot}", f"/v1/logs/{log}", *job["links"].values()]
    for path in paths:
        assert guarded.get(path, headers=mine).status_code == 200, path
        assert_problem(guarded.get(path, headers=other), 404, "not-found")
    for path in [*paths[:2], job["links"]["self"]]:
        assert_problem(guarded.delete(path, headers=other), 404, "not-found")
    assert_problem(guarded.post("/v1/jobs", json=asked, headers=other), 422, "unknown-reference")
    for kind in ("logs", "jobs"):
        assert guarded.get(f"/v1/{kind}", headers=other).json()[kind] == []
    built_in = [one["id"] for one in guarded.get("/v1/robots", headers=other).json()["robots"]]
    assert built_in == ["yumi-left", "yumi-right", "yumi"]


def test_the_same_request_of_two_tenants_is_two_jobs(guarded, made):
    jobs = []
    for tenant in ("one", "two"):
        key = made(tenant)
        robot = guarded.post("/v1/robots", json=description(), headers=key).json()["id"]
        log = guarded.post("/v1/logs", content=csv_log(seconds=4.0), headers=key | CSV).json()["id"]
        asked = {"kind": "identify", "robot": robot, "logs": [log], "options": {}}
        jobs.append(guarded.post("/v1/jobs", json=asked, headers=key).json()["id"])
    assert jobs[0] != jobs[1]


def test_a_key_that_was_revoked_is_refused(guarded, made):
    header = made("leaving")
    services = guarded.app.state.services
    assert guarded.get("/v1/jobs", headers=header).status_code == 200
    known = services.keys.find(header["Authorization"].split()[1])
    assert KeyStore(services.store.database).revoke(known.id)
    services.keys._until = 0.0
    assert_problem(guarded.get("/v1/jobs", headers=header), 401, "no-key")


def test_the_contract_says_where_a_key_belongs(guarded):
    contract = guarded.get("/openapi.json").json()
    assert contract["components"]["securitySchemes"]["key"]["scheme"] == "bearer"
    for path, operations in contract["paths"].items():
        for operation in operations.values():
            assert ("security" in operation) == path.startswith("/v1/")
            assert {"401", "403"} <= set(operation["responses"]) or path in OPEN
