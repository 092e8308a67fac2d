"""Hold what an operator may choose, read once from the environment (``VERITORQUE_PORT=9000``).

Settings never change afterwards. The command line offers the same by the same names, so that a container and
a terminal are told the same thing.
"""

import ipaddress
from pathlib import Path

from pydantic import Field
from pydantic_settings import BaseSettings, SettingsConfigDict

PREFIX = "VERITORQUE_"


class Settings(BaseSettings):
    """Choose where the service listens, where it keeps its data, and how much it takes on.

    Attributes
    ----------
    host, port
        Address to listen on; loopback unless `allow_remote` is set.
    data_dir
        Directory of the database, the uploaded logs, the results and the compiled kernels.
    max_upload_bytes
        Largest log taken.
    workers
        Computations that run at the same time, each in its own process.
    job_timeout_s
        Longest a computation may take, s.
    allow_remote
        Permit a `host` that other machines can reach. There are no keys yet: whoever reaches the port may use
        the service.
    """

    model_config = SettingsConfigDict(env_prefix=PREFIX, frozen=True, allow_inf_nan=False)

    host: str = Field(default="127.0.0.1", min_length=1, max_length=255)
    port: int = Field(default=8000, ge=0, le=65535)
    data_dir: Path = Path("data")
    max_upload_bytes: int = Field(default=2 * 1024**3, ge=1024)
    workers: int = Field(default=1, ge=1, le=64)
    job_timeout_s: float = Field(default=600.0, gt=0.0, le=86400.0)
    allow_remote: bool = False


def reaches_other_machines(host: str) -> bool:
    """Tell whether an address to listen on is anything but loopback.

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
