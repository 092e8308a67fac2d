"""Bound what a tenant may have, within the transaction that would give it more."""

import math

from sqlalchemy import Connection, bindparam, func, literal, select

from .database import lock_in_turn
from .errors import OverQuotaError
from .records import UNFINISHED, Quota
from .tables import JOBS, LOGS, one_of

UNFINISHED_JOBS = select(func.count()).select_from(
    select(literal(1))
    .where(JOBS.c.tenant == bindparam("tenant"), one_of(JOBS.c.state, UNFINISHED))
    .limit(bindparam("most"))
    .subquery()
)
"""No more than `most` of them are counted."""


def room_for_jobs(connection: Connection, tenant: str, quota: Quota) -> float:
    """Say how many more jobs the tenant may ask for before some of them are finished."""
    if quota.queued is None:
        return math.inf
    lock_in_turn(connection, f"jobs of {tenant}")
    counted = connection.execute(UNFINISHED_JOBS, {"tenant": tenant, "most": quota.queued}).scalar_one()
    return quota.queued - int(counted)


def refuse_beyond(connection: Connection, tenant: str, quota: Quota) -> None:
    """Refuse a log, which is among the others already, where it is too much.

    Raises
    ------
    OverQuotaError
        If the tenant has more bytes than it may have.
    """
    if quota.stored_bytes is not None:
        lock_in_turn(connection, f"bytes of {tenant}")
        refuse_more(connection, tenant, quota, 0)


def refuse_more(connection: Connection, tenant: str, quota: Quota, size: int) -> None:
    """Refuse so many bytes beside those that are there, where they are too much.

    Raises
    ------
    OverQuotaError
        If the tenant would have more bytes than it may have.
    """
    if quota.stored_bytes is not None and stored_bytes(connection, tenant) + size > quota.stored_bytes:
        raise OverQuotaError("bytes", most=quota.stored_bytes, setting="VERITORQUE_STORED_BYTES_PER_TENANT")


def stored_bytes(connection: Connection, tenant: str) -> int:
    """Count the bytes of a tenant's logs and results."""
    logs = select(func.coalesce(func.sum(LOGS.c.bytes), 0)).where(LOGS.c.tenant == tenant)
    results = select(func.coalesce(func.sum(JOBS.c.result_bytes), 0)).where(JOBS.c.tenant == tenant)
    return int(connection.execute(logs).scalar_one()) + int(connection.execute(results).scalar_one())
