"""Report the progress of jobs to many clients with few queries.

A job may be computed by another process, so the database is asked, and nothing is cached. Questions
that come while one is being answered are asked together, and all who wait for changes share one query of the
versions every few milliseconds.
"""

import asyncio
import logging
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import TypeVar

from ..problems import Problem
from ..store.errors import UnavailableError
from ..store.many import ManyJobs, Place
from ..store.records import JobRecord

LOGGER = logging.getLogger(__name__)
POLL_S = 0.005
POLL_SHARE = 0.1
"""Largest share of the time that is spent on polling."""
Given = TypeVar("Given")


def _future() -> asyncio.Future[None]:
    return asyncio.get_running_loop().create_future()


@dataclass
class _Topic:
    """Hold the known version of a job that requests wait for, and the future that wakes them."""

    version: int | None = None
    listeners: int = 0
    changed: asyncio.Future[None] = field(default_factory=_future)

    def publish(self, version: int | None) -> None:
        """Wake all listeners."""
        self.version = version
        self.changed.set_result(None)
        self.changed = _future()


class JobFeed:
    """Read jobs for all requests of a service, on its event loop.

    Parameters
    ----------
    jobs
        Where jobs are.
    """

    def __init__(self, jobs: ManyJobs) -> None:
        self._jobs = jobs
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="feed")
        self._asked: dict[Place, asyncio.Future[JobRecord | None]] = {}
        self._topics: dict[Place, _Topic] = {}
        self._reading: asyncio.Task[None] | None = None
        self._polling: asyncio.Task[None] | None = None
        self._ending = False

    async def job(self, place: Place) -> JobRecord | None:
        """Read a job as it is now; None where there is none.

        Raises
        ------
        UnavailableError
            If the database does not answer.
        """
        answer = self._asked.get(place)
        if answer is None:
            answer = self._asked[place] = asyncio.get_running_loop().create_future()
            if self._reading is None:
                self._reading = asyncio.create_task(self._read())
        return await asyncio.shield(answer)

    async def change(self, place: Place, *, known: int, seconds: float) -> JobRecord | None:
        """Read a job once its version is not the known one, when the time is over, or when the service ends.

        Raises
        ------
        UnavailableError
            If the database does not answer.
        """
        loop = asyncio.get_running_loop()
        deadline = loop.time() + seconds
        topic = self._topics.setdefault(place, _Topic())
        topic.listeners += 1
        try:
            while True:
                changed = topic.changed
                job = await self.job(place)
                left = deadline - loop.time()
                if job is None or job.version != known or left <= 0.0 or self._ending:
                    return job
                topic.version = job.version
                if self._polling is None:
                    self._polling = asyncio.create_task(self._poll())
                await asyncio.wait((changed,), timeout=left)
        finally:
            topic.listeners -= 1
            if topic.listeners == 0:
                del self._topics[place]

    @property
    def ending(self) -> bool:
        """Return whether the service ends."""
        return self._ending

    def end(self) -> None:
        """End all waiting, because the service ends."""
        self._ending = True
        for topic in self._topics.values():
            topic.publish(topic.version)

    async def close(self) -> None:
        """Finish the open queries, and end the thread."""
        self.end()
        for task in (self._reading, self._polling):
            if task is not None:
                await task
        self._thread.shutdown()

    async def _read(self) -> None:
        """Answer what is asked until nothing is, and what gathers meanwhile in one question."""
        while self._asked:
            asked, self._asked = self._asked, {}
            try:
                found = await self._in_thread(self._jobs.records, tuple(asked))
            except Exception as error:  # noqa: BLE001 - it is every caller's answer
                for answer in asked.values():
                    answer.set_exception(error)
            else:
                for place, answer in asked.items():
                    answer.set_result(found.get(place))
        self._reading = None

    async def _poll(self) -> None:
        """Poll for new versions as long as requests wait for one."""
        pause, clock = POLL_S, asyncio.get_running_loop()
        try:
            while await asyncio.sleep(pause, self._topics) and not self._ending:
                begun = clock.time()
                await self._poll_once(tuple(self._topics))
                pause = max(POLL_S, (clock.time() - begun) / POLL_SHARE)
        finally:
            self._polling = None

    async def _poll_once(self, watched: tuple[Place, ...]) -> None:
        try:
            versions = await self._in_thread(self._jobs.versions, watched)
        except UnavailableError as error:
            LOGGER.warning("changes of jobs cannot be seen: %s", error.reason)
            versions = {}  # requests that wait then ask by themselves, and fail with the reason
        for place in watched:
            topic = self._topics.get(place)
            if topic is not None and versions.get(place) != topic.version:
                topic.publish(versions.get(place))

    async def _in_thread(self, work: Callable[[Sequence[Place]], Given], places: Sequence[Place]) -> Given:
        return await asyncio.get_running_loop().run_in_executor(self._thread, work, places)


async def wait_for(feed: JobFeed, job: JobRecord, seconds: float) -> JobRecord:
    """Give the job as it is when it is finished, when the time is over, or when the service ends."""
    deadline = time.monotonic() + seconds
    while not job.finished and not feed.ending and (left := deadline - time.monotonic()) > 0.0:
        now = await feed.change((job.tenant, job.id), known=job.version, seconds=left)
        if now is None:  # deleted meanwhile
            return job
        job = now
    return job


def no_such_job(identity: str) -> Problem:
    """Say that there is no such job."""
    return Problem(
        "not-found",
        f"there is no job {identity}",
        evidence={"job": identity},
        remedy="GET /v1/jobs lists what there is",
    )
