"""Ask for jobs as a patient client does: again with the same key until there is an answer."""

import json
import threading
import time
import urllib.error
import urllib.request
from http.client import HTTPException

from tests.app.planar_arm import csv_log, description

LOGS = 4
WAITING = 24
"""Jobs that are asked for and not finished, at most."""
FOLLOW_S = 0.5
"""How often it is asked how far they are."""
GAVE_UP = "urn:veritorque:problem:computation-stopped"


class Customer:
    """Asks for one identification after the other, each of its own, and remembers what was promised.

    `jobs` are the ids by number of the request, `finished` what was seen of each when it was first seen
    finished, `asked_again` counts jobs that were given up because whoever computed them died three times.
    """

    def __init__(self, address):
        self.jobs, self.finished, self.asked_again = {}, {}, 0
        self._address = address
        self.enough = threading.Event()
        self._tries = {}

    def prepare(self):
        """Create the robot and upload the logs."""
        self.robot = self._ask("POST", "/v1/robots", json.dumps(description()).encode(), "application/json")
        self.logs = [
            self._ask("POST", "/v1/logs", csv_log(seconds=4.0, seed=seed), "text/csv") for seed in range(LOGS)
        ]

    def request(self, number):
        """Give the body of a request; no two are alike."""
        options = {"filter": {"cutoff_hz": 5.0 + 0.002 * number}}
        log = self.logs[number % LOGS]["id"]
        return {"kind": "identify", "robot": self.robot["id"], "logs": [log], "options": options}

    def keep_busy(self):
        """Ask for jobs until there are enough, then see all of them finished."""
        number = 0
        while not (self.enough.is_set() and self.jobs.keys() == self.finished.keys()):
            if not self.enough.is_set() and len(self.jobs) - len(self.finished) < WAITING:
                self._place(number)
                number += 1
            else:
                time.sleep(FOLLOW_S)
            self._follow()

    def read(self, number):
        """Read the job and the bytes of its result, as they are now."""
        job = self._ask("GET", f"/v1/jobs/{self.jobs[number]}")
        return job, self._send("GET", f"/v1/jobs/{self.jobs[number]}/results")

    def _place(self, number):
        key = f"{number}-{self._tries.get(number, 0)}"
        body = json.dumps(self.request(number)).encode()
        job = self._ask("POST", "/v1/jobs", body, "application/json", {"Idempotency-Key": key})
        self.jobs[number] = job["id"]

    def _follow(self):
        for number in self.jobs.keys() - self.finished.keys():
            job = self._ask("GET", f"/v1/jobs/{self.jobs[number]}")
            if job["state"] == "failed" and job["problem"]["type"] == GAVE_UP:
                self.asked_again += 1
                self._tries[number] = self._tries.get(number, 0) + 1
                self._place(number)
            elif job["state"] in ("successful", "failed", "dismissed"):
                self.finished[number] = job

    def _ask(self, *request):
        return json.loads(self._send(*request))

    def _send(self, method, path, body=None, media_type=None, headers=None):
        headers = dict(headers or {}) | ({"Content-Type": media_type} if media_type else {})
        deadline = time.monotonic() + 300.0
        while True:
            asked = urllib.request.Request(self._address + path, body, headers, method=method)  # noqa: S310 - our own
            try:
                with urllib.request.urlopen(asked, timeout=30.0) as answer:  # noqa: S310 - our own address
                    return answer.read()
            except urllib.error.HTTPError as error:
                if error.code != 503 or time.monotonic() > deadline:
                    raise AssertionError(f"{method} {path}: {error.code} {error.read()!r}") from None
            except (OSError, HTTPException):  # the service was killed meanwhile, perhaps in mid-answer
                if time.monotonic() > deadline:
                    raise
            time.sleep(0.1)
