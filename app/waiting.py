"""Wait for a job without holding a thread: patience costs a look at the database now and then."""

import time

import anyio

from app.store.records import JobRecord
from app.store.store import TenantStore

FIRST_PAUSE_S, LONGEST_PAUSE_S = 0.02, 0.25


async def wait_for(store: TenantStore, job: JobRecord, seconds: float) -> JobRecord:
    """Give the job as it is when it is finished, or when the time is over."""
    deadline = time.monotonic() + seconds
    pause = FIRST_PAUSE_S
    while not job.finished and (left := deadline - time.monotonic()) > 0.0:
        await anyio.sleep(min(pause, left))
        pause = min(1.5 * pause, LONGEST_PAUSE_S)
        now = await anyio.to_thread.run_sync(store.jobs.get, job.id)
        if now is None:  # deleted meanwhile
            return job
        job = now
    return job
