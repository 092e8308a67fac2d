"""Let two tenants do at random what the contract allows, with each other's ids too, and look for leaks."""

import random

from starlette.testclient import TestClient

from tests.app.planar_arm import csv_log, description
from tests.app.stubs import StubExecutor
from veritorque.app.main import create_app
from veritorque.app.settings import Settings

TENANTS = ("anna", "bert")
FOREIGN = (404, 422)
"""Answers to requests that name what is somebody else's, the latter where a body names it."""


class Tenants:
    """Two tenants of one service.

    `operations` counts requests, `crossed` those that named something of the other's, `leaks` those whose
    answer told anything about it.
    """

    def __init__(self, directory, seed):
        self.operations = self.crossed = self.leaks = 0
        self._random = random.Random(seed)  # noqa: S311 - repeatable
        executor = StubExecutor()
        executor.release.set()
        settings = Settings(
            data_dir=directory,
            host="0.0.0.0",  # noqa: S104 - guarded by keys
            hosts=("testserver",),
            requests_per_second=1e9,
        )
        self._client = TestClient(create_app(settings, executor=executor))
        self._log = csv_log(seconds=2.0)
        self._ids = {tenant: {"robots": [], "logs": [], "jobs": []} for tenant in TENANTS}

    def __enter__(self):
        self._client.__enter__()
        keys = self._client.app.state.services.keys
        self._secrets = {
            one: keys._store.create(tenant=one, name=one, scopes=("read", "write"))[1] for one in TENANTS
        }
        keys._until = 0.0
        return self

    def __exit__(self, *error):
        self._client.__exit__(*error)

    def act(self):
        """Do one thing in the name of one of them."""
        me, other = self._random.sample(TENANTS, 2)
        actions = (self._create_robot, self._upload, self._ask_for_job, self._list, *[self._touch] * 6)
        self._random.choice(actions)(me, other)

    def _create_robot(self, me, other):
        robot = description() | {"name": f"{me}s arm {self._random.randrange(20)}"}
        self._keep(me, "robots", self._send(me, other, "POST", "/v1/robots", json=robot))

    def _upload(self, me, other):
        path = f"/v1/logs?name={me}s-log-{self._random.randrange(20)}"
        answer = self._send(me, other, "POST", path, content=self._log, headers={"Content-Type": "text/csv"})
        self._keep(me, "logs", answer)

    def _ask_for_job(self, me, other):
        robot, log = self._any("robots"), self._any("logs")
        if robot is None or log is None:
            return
        body = {"kind": "identify", "robot": robot, "logs": [log], "options": {}}
        headers = {"Idempotency-Key": str(self._random.randrange(50))}
        answer = self._send(me, other, "POST", "/v1/jobs", json=body, headers=headers)
        if self._foreign(other, robot, log):
            self._cross(answer)
        else:
            self._keep(me, "jobs", answer)

    def _list(self, me, other):
        kind = self._random.choice(["robots", "logs", "jobs"])
        self._send(me, other, "GET", f"/v1/{kind}?limit={self._random.choice([1, 5, 1000])}")

    def _touch(self, me, other):
        """Read or delete something, whoever it belongs to, by any of its addresses."""
        kind = self._random.choice(["robots", "logs", "jobs"])
        identity = self._any(kind)
        if identity is None:
            return
        computed = ["/base-parameters"] if self._foreign(other, identity) else []  # our own take a while
        tails = {"robots": ["", *computed], "logs": [""]}
        tail = self._random.choice(tails.get(kind, ["", "/results", "/report", "/results/parameters.csv"]))
        method = "DELETE" if not tail and self._random.random() < 0.15 else "GET"
        answer = self._send(me, other, method, f"/v1/{kind}/{identity}{tail}")
        if self._foreign(other, identity):
            self._cross(answer)
        elif answer.status_code == 204:
            self._ids[me][kind].remove(identity)

    def _send(self, me, other, method, path, *, headers=None, **content):
        """Send a request; its answer may hold no id and no name of the other's, but for what was asked by."""
        self.operations += 1
        key = {"Authorization": f"Bearer {self._secrets[me]}"}
        answer = self._client.request(method, path, headers={**key, **(headers or {})}, **content)
        told = answer.text + str(answer.headers)
        asked = path + str(content.get("json", ""))
        secret = [one for kind in self._ids[other].values() for one in kind if one not in asked]
        self.leaks += f"{other}s" in told or any(one in told for one in secret)
        return answer

    def _cross(self, answer):
        self.crossed += 1
        self.leaks += answer.status_code not in FOREIGN

    def _keep(self, me, kind, answer):
        if answer.status_code < 300:
            known, identity = self._ids[me][kind], answer.json()["id"]
            known += [] if identity in known else [identity]

    def _any(self, kind):
        everything = [one for tenant in TENANTS for one in self._ids[tenant][kind]]
        return self._random.choice(everything) if everything else None

    def _foreign(self, other, *identities):
        return any(one in kind for one in identities for kind in self._ids[other].values())
