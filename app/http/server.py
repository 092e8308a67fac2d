"""Listen as uvicorn does, and look at the connections now and then."""

import asyncio
import gc
import socket

import uvicorn
from fastapi import FastAPI

from ..settings import Settings
from .connection import PatientConnection

TICKS_PER_LOOK = 5
"""uvicorn ticks ten times a second."""
GRACE_S = 5
"""What is under way when the service is told to stop may take so long."""
LAST_WORD_S = 4.0
"""What is not done by then is refused, while there is time to say so."""


class Server(uvicorn.Server):
    """Serve an application, and look at its connections.

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
                http=PatientConnection,
                ws="none",
                server_header=False,
                log_config=None,  # it writes into the service's journal, as all that runs here does
                log_level="info",
                access_log=False,
                timeout_graceful_shutdown=GRACE_S,
            )
        )
        self._app = app

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Begin to listen, and leave all that was loaded until now out of every later collection of garbage.

        There are some 300,000 objects of libraries: to go through them takes a tenth of a second, in which no
        request is answered.
        """
        await super().startup(sockets)
        gc.collect()
        gc.freeze()

    async def on_tick(self, counter: int) -> bool:
        """Look at all connections now and then."""
        if counter % TICKS_PER_LOOK == 0:
            for connection in self._connections:
                connection.look()
        return await super().on_tick(counter)

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Let nobody wait for a job any longer, then close."""
        self._app.state.services.feed.end()
        giving_up = asyncio.get_running_loop().call_later(LAST_WORD_S, self._give_up)
        await super().shutdown(sockets)
        giving_up.cancel()

    def _give_up(self) -> None:
        for connection in self._connections:
            connection.give_up()

    @property
    def _connections(self) -> list[PatientConnection]:
        return [one for one in self.server_state.connections if isinstance(one, PatientConnection)]
