"""Choose the backend of a command by its options."""

from collections.abc import Iterator
from contextlib import contextmanager

from .protocol import Backend


@contextmanager
def open_backend(url: str, key: str) -> Iterator[Backend]:
    """Give the service at `url` as the backend, or this process where it is empty."""
    if url:
        from ...client.client import Client
        from .remote import RemoteBackend

        with Client(url, key or None) as client:
            yield RemoteBackend(client)
    else:
        from .local import LocalBackend

        yield LocalBackend()
