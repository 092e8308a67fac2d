"""Say in a few lines what the life of a job is, and hold the store to it, whatever happens in which order."""

import os
import shutil
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, rule

from tests.app.stubs import add_job
from tests.chaos.run import MEMORY
from veritorque.app.jobs.liveness import Presence
from veritorque.app.jobs.reclaim import Reclaimer
from veritorque.app.store.blobs.sweep import Sweep
from veritorque.app.store.errors import KeyReusedError
from veritorque.app.store.records import JobRequestRecord
from veritorque.app.store.store import Store
from veritorque.app.store.work import MOST_ATTEMPTS

MOST_RUNNING = 2
OWNERS = ("one", "two")
PROBLEM = {"cause": "it was to be"}
ALIVE = ("accepted", "running", "successful")


@dataclass(frozen=True)
class Life:
    """Know of a job what its customer may rely on."""

    request: int
    state: str = "accepted"
    attempts: int = 0
    token: int = 0
    owner: str | None = None
    result: bytes | None = None


class JobLives(RuleBasedStateMachine):
    """Do to a store whatever customers, workers and accidents do, and to a dictionary the same."""

    numbers = st.integers(0, 3)
    picks = st.integers(0, 9)
    owners = st.sampled_from(OWNERS)

    @initialize()
    def open(self):
        self.folder = tempfile.mkdtemp(dir=MEMORY if MEMORY.is_dir() else None)
        self.jobs, self.keys, self.held = {}, {}, []
        self._open()
        self.workers = {owner: self._presence() for owner in OWNERS}

    def teardown(self):
        if hasattr(self, "folder"):
            for presence in (*self.workers.values(), self.watcher):
                presence.leave()
            self.store.close()
            shutil.rmtree(self.folder)

    # ------------------------------------------------------------------------------------- what customers do
    @rule(number=numbers, key=st.sampled_from([None, "a", "b"]))
    def create_or_retry(self, number, key):
        known, identity = self.keys.get(key), None
        if known is not None and known[0] != number:
            self._assert_refused(number, key)
            return
        if known is not None and known[1] in self.jobs:
            identity = known[1]
        identity = identity or next((i for i, job in self.jobs.items() if self._answers(job, number)), None)
        given = add_job(self.mine, _request(number), key=key).id
        assert identity in (None, given)
        if identity is None:
            assert given not in self.jobs
            self.jobs[given] = Life(number)
        if key is not None:
            self.keys[key] = (number, given)

    @rule(pick=picks)
    def cancel(self, pick):
        identity = self._picked(pick)
        given = self.mine.dismiss(identity)
        if identity in self.jobs and self.jobs[identity].state in ("accepted", "running"):
            self._now(identity, state="dismissed")
        assert (given and given.state) == (self.jobs[identity].state if identity in self.jobs else None)

    @rule(pick=picks)
    def delete(self, pick):
        identity = self._picked(pick)
        finished = identity in self.jobs and self.jobs[identity].state not in ("accepted", "running")
        assert self.mine.remove(identity) == finished
        if finished:
            del self.jobs[identity]

    # --------------------------------------------------------------------------------------- what workers do
    @rule(owner=owners)
    def take(self, owner):
        running = sum(job.state == "running" for job in self.jobs.values())
        waiting = [identity for identity, job in self.jobs.items() if job.state == "accepted"]
        taken = self.store.work.claim(self.workers[owner].name, most_per_tenant=MOST_RUNNING)
        if running >= MOST_RUNNING or not waiting:
            assert taken is None
            return
        job = self.jobs[waiting[0]]
        assert (taken.id, taken.token, taken.attempts) == (waiting[0], job.token + 1, job.attempts + 1)
        self._now(taken.id, state="running", owner=owner, token=taken.token, attempts=taken.attempts)
        self.held.append((taken.id, taken.token))

    @rule(pick=picks, end=st.sampled_from(["succeed", "fail", "hand back", "die", "report"]))
    def end(self, pick, end):
        """Let a worker write something down under a token that it has, or once had."""
        held = self.held[pick % len(self.held)] if self.held else ("job-none", 1)
        job = self.jobs.get(held[0])
        valid = job is not None and job.state == "running" and job.token == held[1]
        result = f"{held}".encode()
        work = self.store.work
        if end == "report":
            work.report(held, stage="on the way", fraction=0.5)
            return
        done = {
            "succeed": lambda: self.store.keep_result(held, result),
            "fail": lambda: work.fail(held, PROBLEM),
            "hand back": lambda: work.hand_back(held),
            "die": lambda: work.retry_or_fail(held, PROBLEM),
        }[end]()
        assert done == valid
        if valid:
            self._ended(held[0], end, result)

    @rule(owner=owners)
    def kill(self, owner):
        """Kill a worker: its lock is free, and whoever watches takes its jobs back."""
        os.close(self.workers[owner]._file)
        Reclaimer(self.store, self.watcher).run()
        for identity, job in list(self.jobs.items()):
            if job.state == "running" and job.owner == owner:
                self._ended(identity, "die", None)
        self.workers[owner] = self._presence()

    # ------------------------------------------------------------------------------ what happens to a service
    @rule()
    def restart(self):
        self.store.close()
        self.watcher.leave()
        self._open()

    @rule()
    def sweep(self):
        sweep = Sweep(self.store)
        sweep.run()
        sweep.run()
        assert self.store.blobs.marks().keys() == self.store.needed()

    @invariant()
    def the_store_says_what_was_done(self):
        if not hasattr(self, "folder"):
            return
        found = {job.id: job for job in reversed(self.mine.page(limit=1000))}
        assert list(found) == list(self.jobs)
        for identity, job in self.jobs.items():
            seen = found[identity]
            assert (seen.state, seen.attempts, seen.token) == (job.state, job.attempts, job.token)
            kept = None if seen.result_sha256 is None else self.store.blobs.read(seen.result_sha256)
            assert kept == job.result
            assert (seen.problem is not None) == (job.state == "failed")
        for owner, presence in self.workers.items():
            held = {(i, job.token) for i, job in self.jobs.items() if _is_held(job, owner)}
            assert self.store.work.held(presence.name) == held

    def _open(self):
        self.store = Store(Path(self.folder))
        self.mine = self.store.of("local").jobs
        self.watcher = self._presence()

    def _presence(self):
        return Presence(self.store.directory / "workers")

    def _picked(self, pick):
        return list(self.jobs)[pick % len(self.jobs)] if self.jobs else "job-none"

    def _now(self, identity, **changes):
        self.jobs[identity] = replace(self.jobs[identity], **changes)

    def _ended(self, identity, end, result):
        job = self.jobs[identity]
        if end == "succeed":
            self._now(identity, state="successful", result=result)
        elif end == "fail" or (end == "die" and job.attempts >= MOST_ATTEMPTS):
            self._now(identity, state="failed")
        else:
            self._now(identity, state="accepted", attempts=job.attempts - (end == "hand back"))

    def _assert_refused(self, number, key):
        try:
            add_job(self.mine, _request(number), key=key)
        except KeyReusedError:
            return
        raise AssertionError("a key stood for two requests")

    @staticmethod
    def _answers(job, number):
        return job.request == number and job.state in ALIVE


def _request(number):
    return JobRequestRecord("identify", "arm", (), {"number": number})


def _is_held(job, owner):
    return job.state == "running" and job.owner == owner
