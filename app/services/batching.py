"""Take many requests in together: what comes while others are being written down is written with the next.

A thread per request would spend more on handing over to the next thread than on the request, and a statement
per request more than a statement for all of them.
"""

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Generic, TypeVar

Asked = TypeVar("Asked")
Given = TypeVar("Given")
Begin = Callable[[list[Asked]], Callable[[], list[Given | Exception]]]
"""Begins pieces of work together, and gives what waits for them."""


def _do_nothing() -> None:
    """Do nothing."""


class Batcher(Generic[Asked, Given]):
    """Begin pieces of work in one thread, those of one tenant together, and wait for all that were begun.

    Parameters
    ----------
    on_batch
        Called after every batch.
    """

    def __init__(self, on_batch: Callable[[], None] = _do_nothing) -> None:
        self._on_batch = on_batch
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="batcher")
        self._waiting: dict[str, _Group[Asked, Given]] = {}
        self._serving: asyncio.Task[None] | None = None

    async def take(self, tenant: str, begin: Begin[Asked, Given], asked: Asked) -> Given:
        """Begin a piece of work in the thread, and give what it gives or raise what it raises."""
        outcome: asyncio.Future[Given] = asyncio.get_running_loop().create_future()
        group = self._waiting.setdefault(tenant, _Group(begin))
        group.asked.append(asked)
        group.outcomes.append(outcome)
        if self._serving is None:
            self._serving = asyncio.create_task(self._serve())
        return await outcome

    async def close(self) -> None:
        """Finish what waits, and end the thread."""
        if self._serving is not None:
            await self._serving
        self._thread.shutdown()

    async def _serve(self) -> None:
        loop = asyncio.get_running_loop()
        while self._waiting:
            groups, self._waiting = list(self._waiting.values()), {}
            given = await loop.run_in_executor(self._thread, _run_groups, groups)
            self._on_batch()
            for group, outcomes in zip(groups, given, strict=True):
                group.resolve(outcomes)
        self._serving = None


class _Group(Generic[Asked, Given]):
    """Hold what is asked of one tenant, and who waits for it."""

    def __init__(self, begin: Begin[Asked, Given]) -> None:
        self.begin = begin
        self.asked: list[Asked] = []
        self.outcomes: list[asyncio.Future[Given]] = []

    def resolve(self, given: list[Given | Exception]) -> None:
        """Give every request its outcome."""
        for outcome, answer in zip(self.outcomes, given, strict=True):
            if outcome.cancelled():  # the client is gone
                continue
            if isinstance(answer, Exception):
                outcome.set_exception(answer)
            else:
                outcome.set_result(answer)


def _run_groups(groups: list[_Group[Asked, Given]]) -> list[list[Given | Exception]]:
    waits = [_begin(group) for group in groups]
    return [_finish(group, wait) for group, wait in zip(groups, waits, strict=True)]


def _begin(group: _Group[Asked, Given]) -> Callable[[], list[Given | Exception]]:
    try:
        return group.begin(group.asked)
    except Exception as error:  # noqa: BLE001 - it is every caller's answer
        failed: list[Given | Exception] = [error] * len(group.asked)
        return lambda: failed


def _finish(
    group: _Group[Asked, Given], wait: Callable[[], list[Given | Exception]]
) -> list[Given | Exception]:
    try:
        return wait()
    except Exception as error:  # noqa: BLE001 - it is every caller's answer
        return [error] * len(group.asked)
