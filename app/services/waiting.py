"""Wait for a job to finish without holding a thread."""

import time

from ..store.records import JobRecord
from .job_feed import JobFeed


async def wait_for(feed: JobFeed, job: JobRecord, seconds: float) -> JobRecord:
    """Give the job as it is when it is finished, when the time is over, or when the service ends."""
    deadline = time.monotonic() + seconds
    while not job.finished and not feed.ending and (left := deadline - time.monotonic()) > 0.0:
        now = await feed.change((job.tenant, job.id), known=job.version, seconds=left)
        if now is None:  # deleted meanwhile
            return job
        job = now
    return job
