"""Write down how far a job is, seldom enough that progress costs less than the work."""

import logging
import time

from ..store.errors import Unavailable
from ..store.store import Store
from ..store.work import Held

LOGGER = logging.getLogger(__name__)
REPORT_EVERY_S = 0.2


class Reporter:
    """Write progress to the store: every new stage, and fractions a few times a second."""

    def __init__(self, store: Store, held: Held) -> None:
        self._store, self._held = store, held
        self._stage, self._next = "", 0.0

    def __call__(self, stage: str, fraction: float) -> None:
        """Say how far a job is."""
        if stage == self._stage and time.monotonic() < self._next:
            return
        self._stage, self._next = stage, time.monotonic() + REPORT_EVERY_S
        try:
            self._store.work.report(self._held, stage=stage, fraction=fraction)
        except Unavailable as error:
            LOGGER.warning("progress is not written: %s", error.reason)
