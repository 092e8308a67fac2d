"""Kill and freeze the processes of a service that works, and judge what is left."""

import signal
import tempfile
import threading
import time
from pathlib import Path

from tests.chaos.customer import Customer
from tests.chaos.failures import Failures
from tests.chaos.judge import compare
from tests.chaos.processes import Fleet
from veritorque.app.store.store import Store

MEMORY = Path("/dev/shm")  # noqa: S108 - what is killed is processes: what they wrote need not reach a disk
TOLD = 4000
"""Letters of the services' own log that are shown where a run fails."""
ENDED_WELL = (0, -signal.SIGTERM)  # uvicorn ends in order, then by the signal that it was told to end with


def chaos(*, jobs, kills, freezes, seed, url=None, workers=4, tell=lambda text: None):
    """Give the figures, and the failures that they survived."""
    with tempfile.TemporaryDirectory(prefix="vt-chaos-", dir=MEMORY if MEMORY.is_dir() else None) as folder:
        fleet = Fleet(_made(Path(folder) / "data"), url, workers)
        customer = Customer(fleet.address)
        failures = Failures(
            fleet, lambda: len(customer.finished), jobs=jobs, kills=kills, freezes=freezes, seed=seed
        )
        try:
            customer.prepare()
            asking = threading.Thread(target=customer.keep_busy, daemon=True)
            causing = threading.Thread(target=failures.cause, daemon=True)
            asking.start()
            causing.start()
            _wait(fleet, customer, failures, asking, jobs, tell)
            return _judged(fleet, customer, url, tell), failures
        except BaseException:
            tell((Path(folder) / "journal").read_text()[-TOLD:])
            raise
        finally:
            failures.stop.set()
            failures.ended.wait(60.0)
            fleet.close()


def _judged(fleet, customer, url, tell):
    """Compare while the service still answers, then end it, remove what is needless, and examine the rest."""
    store = Store(fleet.directory, url)
    figures = compare(customer, store)
    codes = fleet.close()
    figures.left = len(fleet.left())
    fleet.command("gc", "--pause-s", "1")
    figures.orphans = len(store.blobs.marks().keys() - store.needed())
    store.close()
    code, said = fleet.command("doctor")
    figures.harm = (code != 0) + sum(one not in ENDED_WELL for one in codes)
    if figures.harm:
        tell(f"{codes} {said}")
    return figures


def _wait(fleet, customer, failures, asking, jobs, tell):
    begun = told = time.monotonic()
    while asking.is_alive():
        if failures.ended.is_set():
            fleet.revive()
            if len(customer.jobs) >= jobs:
                customer.enough.set()
        if time.monotonic() - told > 30.0:
            told = time.monotonic()
            tell(
                f"{told - begun:5.0f} s: {len(customer.finished)} of {len(customer.jobs)} jobs finished, "
                f"killed {failures.kills}, froze {failures.freezes}"
            )
        asking.join(0.2)
    if not customer.enough.is_set() or customer.jobs.keys() != customer.finished.keys():
        raise AssertionError("the customer gave up")


def _made(directory):
    directory.mkdir(mode=0o700)
    return directory
