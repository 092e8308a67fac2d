"""Reclaim the jobs of workers that died, froze or were cut off, so that others compute them.

How long a worker has been silent is measured by this worker's own steady clock, never by the time of day: a
clock that is set back an hour takes no job from anybody. Source: Gray & Cheriton, Leases, SOSP 1989.
"""

import time
from collections.abc import Callable

from ..problems import Problem
from ..store.store import Store
from ..store.work import MOST_ATTEMPTS, Held
from .liveness import Presence

LEASE_S = 10.0
"""A worker without a heartbeat for so long no longer holds its jobs."""


class Reclaimer:
    """Watch the other workers, and reclaim their jobs.

    Parameters
    ----------
    clock
        Gives monotonic seconds.
    """

    def __init__(
        self, store: Store, presence: Presence, *, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._work, self._presence, self._clock = store.work, presence, clock
        self._seen: dict[Held, tuple[int, float]] = {}

    def run(self) -> int:
        """Reclaim the jobs of workers that are gone or silent, and count them."""
        now, reclaimed = self._clock(), 0
        elsewhere = self._work.running_elsewhere(self._presence.name)
        seen = {}
        for held, (owner, beat) in elsewhere.items():
            known_beat, since = self._seen.get(held, (beat, now))
            seen[held] = (beat, since if known_beat == beat else now)
            if self._presence.is_gone(owner):
                reclaimed += self._work.retry_or_fail(held, died_too_often().document())
            elif now - seen[held][1] > LEASE_S:
                reclaimed += self._work.retry_or_fail(held, died_too_often().document(), beat=beat)
        self._seen = seen
        self._presence.tidy()
        return reclaimed


def died_too_often() -> Problem:
    """Report a job whose worker process ended or hung too often."""
    return Problem(
        "computation-stopped",
        f"the process that computed this job ended or hung {MOST_ATTEMPTS} times, so it is not tried again",
        evidence={"attempts": MOST_ATTEMPTS},
        remedy="shorten the log or raise the decimation; the service's own log may say more",
    )
