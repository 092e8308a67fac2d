"""Follow a job to its end: by events as they come, again from the last one where they break, else by asking.

Networks break, services are started anew and proxies cut streams; none of this is the end of a job.
"""

import time
from collections.abc import Iterator
from itertools import chain
from typing import Final

from .errors import NoAnswerError, RefusedError, ServiceError
from .records import Job
from .transport import Transport, segment

PATIENCE_S: Final = 30.0
"""How long a service may be away, s."""
PAUSE_S: Final = 0.5
BARREN: Final = 3
"""Streams without an event after which the service is only asked."""
PASSING: Final = frozenset({"not-ready", "stopping", "unavailable", "too-many"})
"""Problems that pass by themselves."""


class Follower:
    """Follow one job.

    Parameters
    ----------
    pause_s
        Between two attempts or questions, s.
    """

    def __init__(self, transport: Transport, identity: str, *, pause_s: float = PAUSE_S) -> None:
        self._transport, self._path, self._pause_s = transport, f"/v1/jobs/{segment(identity)}", pause_s
        self._last, self._barren = "", 0
        self._seen = time.monotonic()

    def changes(self) -> Iterator[Job]:
        """Give the job at every change; the last one is finished.

        Raises
        ------
        RefusedError
            If there is no such job, or it may not be read.
        NoAnswerError
            If the service stays away for `PATIENCE_S`.
        """
        shown: Job | None = None
        while True:
            for job in chain(self._streamed_jobs(), self._polled_jobs()):
                if job != shown:
                    shown = job
                    yield job
                if job.finished:
                    return
            time.sleep(self._pause_s)

    def _streamed_jobs(self) -> Iterator[Job]:
        """Give the jobs that a stream of events holds, until it ends or breaks."""
        if self._barren >= BARREN:
            return
        self._barren += 1
        try:
            for identity, document in self._transport.events(self._path + "/events", self._last):
                self._last, self._barren = identity, 0
                self._seen = time.monotonic()
                yield Job.from_document(document)
        except ServiceError:
            return  # the next request shows whether this lasts

    def _polled_jobs(self) -> Iterator[Job]:
        """Give what the service says when it is asked; nothing while it is away, as long as that may last."""
        try:
            yield Job.from_document(self._transport.document("GET", self._path))
            self._seen = time.monotonic()
        except (NoAnswerError, RefusedError) as error:
            if isinstance(error, RefusedError) and error.kind not in PASSING:
                raise
            if time.monotonic() - self._seen > PATIENCE_S:
                raise
