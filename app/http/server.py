"""Listen as uvicorn does, and check the connections for slow clients."""

import asyncio
import gc
import socket

import uvicorn
from fastapi import FastAPI

from ..settings import Settings
from .connection import TimedConnection

TICKS_PER_CHECK = 5
"""uvicorn ticks ten times a second."""
GRACE_S = 5
"""Time for requests that are under way when the service is told to stop."""
REFUSE_AFTER_S = 4.0
"""Requests that are not done by then are refused, while there is time to send that."""


class Server(uvicorn.Server):
    """Serve an application, and check its connections.

    Parameters
    ----------
    app
        The application.
    settings
        Where to listen.
    """

    def __init__(self, app: FastAPI, settings: Settings) -> None:
        super().__init__(
            uvicorn.Config(
                app,
                host=settings.host,
                port=settings.port,
                http=TimedConnection,
                ws="none",
                server_header=False,
                log_config=None,  # it writes into the service's own log
                log_level="info",
                access_log=False,
                timeout_graceful_shutdown=GRACE_S,
            )
        )
        self._app = app

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Begin to listen, and exclude all objects that exist by now from garbage collection.

        There are some 300,000 of them: to go through them takes a tenth of a second, in which no request is
        answered.
        """
        await super().startup(sockets)
        gc.collect()
        gc.freeze()

    async def on_tick(self, counter: int) -> bool:
        """Check all connections twice a second."""
        if counter % TICKS_PER_CHECK == 0:
            for connection in self._connections:
                connection.tick()
        return await super().on_tick(counter)

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """End all waiting for jobs, then close."""
        self._app.state.services.feed.end()
        last_call = asyncio.get_running_loop().call_later(REFUSE_AFTER_S, self._refuse_pending)
        await super().shutdown(sockets)
        last_call.cancel()

    def _refuse_pending(self) -> None:
        for connection in self._connections:
            connection.refuse_pending()

    @property
    def _connections(self) -> list[TimedConnection]:
        connections = self.server_state.connections
        return [connection for connection in connections if isinstance(connection, TimedConnection)]
