"""Count what went wrong: nothing else may differ from a service that nobody ever touched."""

from dataclasses import dataclass

from tests.chaos.work import compute
from veritorque.app.jobs.computation import Computation, LogBlob, Workspace
from veritorque.app.json_text import json_bytes
from veritorque.app.settings import LOCAL
from veritorque.app.store.store import Store


@dataclass
class Figures:
    """Count jobs and what went wrong with them; all but the first two have to be zero.

    `orphans` are files that nothing needs, `left` processes that outlive the service.
    """

    jobs: int = 0
    asked_again: int = 0
    lost: int = 0
    double: int = 0
    wrong: int = 0
    changed: int = 0
    orphans: int = 0
    left: int = 0
    harm: int = 0

    @property
    def clean(self):
        missed = self.lost + self.double + self.wrong + self.changed
        return self.jobs > 0 and missed + self.orphans + self.left + self.harm == 0


def compare(customer, store):
    """Hold every answer against what the customer was promised and against a computation in peace."""
    figures = Figures(len(customer.jobs), customer.asked_again)
    for number in customer.jobs:
        job, result = customer.read(number)
        figures.lost += job["state"] != "successful"
        figures.changed += job != customer.finished[number]
        figures.wrong += result != expected(store, customer.request(number))
    figures.double = _count(store) - len(customer.jobs) - customer.asked_again
    return figures


def expected(store, request):
    """Compute a request in this process, in peace."""
    mine = store.of(LOCAL)
    robot, logs = mine.robots.get(request["robot"]), [mine.logs.get(one) for one in request["logs"]]
    blobs = tuple(LogBlob(log.sha256, str(log.summary["name"]), log.summary["mapping"]) for log in logs)
    asked = Computation(request["kind"], robot.description, blobs, request["options"])
    files = {log.sha256: store.blobs.path(log.sha256) for log in logs}
    return json_bytes(compute(asked, Workspace(files), lambda stage, fraction: None))


def _count(store: Store):
    return sum(store.work.count().values())
