"""Limit the rate of requests of every caller: so many a second on average, and a few at once.

A token bucket, kept as one number per caller: when its bucket will be full again. Source: ITU-T I.371 (2004),
the generic cell rate algorithm, which is that.
"""

import math
import time
from collections.abc import Callable

from ..problems import Problem

BURST_S = 4.0
"""Requests of so many seconds may come at once."""
MOST_CALLERS = 10_000
"""Callers that are kept before idle ones are removed."""


class RateLimit:
    """Count the requests of callers.

    Parameters
    ----------
    per_second
        Requests of one caller on average.
    clock
        Gives seconds that only ever grow.
    """

    def __init__(self, per_second: float, *, clock: Callable[[], float] = time.monotonic) -> None:
        self._per_second, self._clock = per_second, clock
        self._full_at: dict[str, float] = {}

    def count(self, caller: str) -> None:
        """Count a request.

        Raises
        ------
        Problem
            If it comes too early (429).
        """
        now = self._clock()
        full_at = max(self._full_at.get(caller, now), now) + 1.0 / self._per_second
        early_s = full_at - now - max(BURST_S, 1.0 / self._per_second)
        if early_s > 1e-9:
            raise _too_many(self._per_second, early_s)
        self._full_at[caller] = full_at
        if len(self._full_at) > MOST_CALLERS:
            self._full_at = {name: full for name, full in self._full_at.items() if full > now}


def _too_many(per_second: float, early_s: float) -> Problem:
    return Problem(
        "too-many",
        f"more than {per_second:g} requests a second",
        evidence={"requests_per_second": per_second, "at_once": BURST_S * per_second, "early_s": early_s},
        remedy="wait as long as Retry-After says, follow jobs by their events rather than by polling, or let "
        "the operator raise VERITORQUE_REQUESTS_PER_SECOND",
        headers={"Retry-After": str(math.ceil(early_s))},
    )
