"""Kill and freeze at random moments, until enough of each was done."""

import itertools
import random
import signal
import threading
import time

from tests.chaos.processes import send

FROZEN_S = 15.0
"""Longer than a lease, and than it takes the others to notice."""
TURNS = ("child", "worker", "child", "service", "child", "worker", "child", "worker", "child", "service")
"""What is killed, in turn; a few kills meet each kind."""
PAUSE_S, EARLY = 0.5, 2
LOOK_S = 0.05
"""How often it is looked for a victim: a job takes a few times as long."""


class Failures:
    """Count what it did in `kills` and `freezes`; it ends when `stop` is set, and then sets `ended`.

    Parameters
    ----------
    finished
        Gives how many jobs are finished; they spread over `jobs` of them.
    """

    def __init__(self, fleet, finished, *, jobs, kills, freezes, seed):
        self._fleet, self._finished, self._jobs = fleet, finished, jobs
        self._random = random.Random(seed)  # noqa: S311 - repeatable
        self.kills, self.freezes = dict.fromkeys(TURNS, 0), 0
        self._turns = itertools.cycle(TURNS)
        self._wanted_kills, self._wanted_freezes = kills, freezes
        self._frozen = {}
        self.stop, self.ended = threading.Event(), threading.Event()

    @property
    def killed(self):
        return sum(self.kills.values())

    def cause(self):
        """Kill and freeze; whatever died is started again."""
        while not self.stop.is_set() and not self._enough():
            self._fleet.revive()
            self._thaw(time.monotonic())
            if self._due(self._wanted_freezes, self.freezes + len(self._frozen)):
                self._freeze()
            if self._due(self._wanted_kills, self.killed):
                self._kill()
            time.sleep(self._random.uniform(0.0, PAUSE_S))
        self._thaw(float("inf"))
        self.ended.set()

    def _enough(self):
        return self.killed >= self._wanted_kills and self.freezes >= self._wanted_freezes

    def _due(self, wanted, done):
        """Tell whether it is time for one more, by how many jobs are finished; a few come early."""
        return done < wanted and done < EARLY + wanted * self._finished() / self._jobs

    def _kill(self):
        kind = next(self._turns)
        deadline = time.monotonic() + 5.0
        while not (victims := self._victims(kind)) and time.monotonic() < deadline:
            time.sleep(LOOK_S)
        if victims:
            self.kills[kind] += send(self._random.choice(victims), signal.SIGKILL)

    def _victims(self, kind):
        if kind == "service":
            return [self._fleet.service.pid] if self._fleet.answers() else []
        workers = [one for one in self._fleet.all_workers() if one not in self._frozen]
        if kind == "worker":
            return workers
        return [one for worker in workers for one in self._fleet.computing(worker)]

    def _freeze(self):
        """Freeze a worker of its own that computes; not that beside the service."""
        free = [one.pid for one in self._fleet.workers if one.pid not in self._frozen]
        for worker in free[1:]:  # one goes on
            if self._fleet.computing(worker) and send(worker, signal.SIGSTOP):
                self._frozen[worker] = time.monotonic()
                return

    def _thaw(self, now):
        for worker, since in list(self._frozen.items()):
            if now - since > FROZEN_S:
                del self._frozen[worker]
                self.freezes += send(worker, signal.SIGCONT)
