"""Hold what an operator may choose, read once from the environment (``VERITORQUE_PORT=9000``).

Settings never change afterwards. The command line offers the same by the same names, so that a container and
a terminal are configured alike.
"""

import ipaddress
import json
from functools import cached_property
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field
from pydantic_settings import BaseSettings, SettingsConfigDict

PREFIX = "VERITORQUE_"
LOCAL = "local"
"""The tenant of requests that need no key."""
SCOPES = ("read", "write", "admin")
"""What keys may permit."""
Kept = Literal["successful", "failed", "dismissed", "logs", "repeats"]
"""Finished jobs by state, logs that no job names, and requests that carried an Idempotency-Key."""


class Settings(BaseSettings):
    """Choose where the service listens, where it keeps its data, and how much it takes on."""

    model_config = SettingsConfigDict(env_prefix=PREFIX, frozen=True, allow_inf_nan=False)

    host: str = Field(default="127.0.0.1", min_length=1, max_length=255)
    port: int = Field(default=8000, ge=0, le=65535)
    """Address to listen on. On loopback no key is needed; on any other there has to be one."""
    hosts: tuple[str, ...] = ()
    """Names by which the service is called, besides loopback's: others in the Host header are refused."""
    data_dir: Path = Path("data")
    """Directory of the database, the uploaded logs, the results and the compiled kernels."""
    database_url: str | None = Field(default=None, pattern=r"^postgresql(\+psycopg)?://", repr=False)
    """Where the database is, ``postgresql://user:password@host/name``; None for the one in `data_dir`."""
    max_upload_bytes: int = Field(default=2 * 1024**3, ge=1024)
    """Largest log taken."""
    disk_reserve_bytes: int = Field(default=512 * 1024**2, ge=0)
    """Free space of the disk below which nothing more is taken."""
    workers: int = Field(default=1, ge=0, le=64)
    """Computations that run at the same time, each in its own process; 0 to leave them to other machines."""
    running_per_tenant: int = Field(default=64, ge=1, le=64)
    """Of these, computations of one tenant."""
    queued_per_tenant: int = Field(default=1000, ge=1)
    stored_bytes_per_tenant: int = Field(default=100 * 1024**3, ge=1024)
    """Unfinished jobs, and bytes of logs and results, that a tenant may have."""
    requests_per_second: float = Field(default=1000.0, gt=0.0)
    """Requests of one caller on average; four times as many may come at once."""
    job_timeout_s: float = Field(default=600.0, gt=0.0, le=86400.0)
    """Longest a computation may take, s."""
    job_memory_bytes: int = Field(default=4 * 1024**3, ge=512 * 1024**2)
    """Most memory that a computation may use; with the solver loaded a quarter of a gibibyte is in use."""
    job_cpus: int = Field(default=1, ge=1, le=64)
    """CPUs that a computation uses."""
    log_level: Literal["debug", "info", "warning", "error"] = "info"
    """What the service's own log holds; with ``debug`` also every read."""

    retention_days: dict[Kept, Annotated[float, Field(gt=0.0)]] = {"repeats": 7.0}
    """How long each of `Kept` is kept, d; what is not named is kept without limit."""

    @cached_property
    def needs_keys(self) -> bool:
        """Return whether requests have to carry a key."""
        return reaches_other_machines(self.host)

    def environment(self) -> dict[str, str]:
        """Write the settings as the environment of another process."""
        chosen = self.model_dump(mode="json", exclude_none=True)
        return {
            PREFIX + name.upper(): value if isinstance(value, str) else json.dumps(value)
            for name, value in chosen.items()
        }


def reaches_other_machines(host: str) -> bool:
    """Return whether an address to listen on is anything but loopback.

    Examples
    --------
    >>> reaches_other_machines("127.0.0.1"), reaches_other_machines("0.0.0.0")
    (False, True)
    """
    if host == "localhost":
        return False
    try:
        return not ipaddress.ip_address(host).is_loopback
    except ValueError:  # a name which is not an address may resolve to anything
        return True
