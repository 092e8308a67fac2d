"""Take many requests in together: what comes while others are being written down is written with the next.

A thread per request would spend more on handing over to the next thread than on the request.
"""

import asyncio
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Generic, TypeVar

Given = TypeVar("Given")
Begin = Callable[[], Future[Given]]


class Intake(Generic[Given]):
    """Begin pieces of work in one thread, and wait for all that were begun together."""

    def __init__(self) -> None:
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="intake")
        self._waiting: list[tuple[Begin[Given], asyncio.Future[Given]]] = []
        self._serving: asyncio.Task[None] | None = None

    async def take(self, begin: Begin[Given]) -> Given:
        """Begin a piece of work in the thread, and give what it gives or raise what it raises."""
        outcome: asyncio.Future[Given] = asyncio.get_running_loop().create_future()
        self._waiting.append((begin, outcome))
        if self._serving is None:
            self._serving = asyncio.create_task(self._serve())
        return await outcome

    async def close(self) -> None:
        """Finish what waits, and let go of the thread."""
        if self._serving is not None:
            await self._serving
        self._thread.shutdown()

    async def _serve(self) -> None:
        while self._waiting:
            taken, self._waiting = self._waiting, []
            begins = [begin for begin, _ in taken]
            ended = await asyncio.get_running_loop().run_in_executor(self._thread, _together, begins)
            for (_, outcome), given in zip(taken, ended, strict=True):
                if outcome.cancelled():  # the client is gone
                    continue
                error = given.exception()
                if error is None:
                    outcome.set_result(given.result())
                else:
                    outcome.set_exception(error)
        self._serving = None


def _together(begins: list[Begin[Given]]) -> list[Future[Given]]:
    begun = [_begun(begin) for begin in begins]
    for one in begun:
        one.exception()  # waits
    return begun


def _begun(begin: Begin[Given]) -> Future[Given]:
    try:
        return begin()
    except Exception as error:  # noqa: BLE001 - it belongs to the one who asked
        failed: Future[Given] = Future()
        failed.set_exception(error)
        return failed
