"""Run the service beside a browser, within this process, on loopback and a free port."""

import contextlib
import socket
import threading
import time

from veritorque.app.http.server import Server
from veritorque.app.main import create_app
from veritorque.app.settings import Settings

START_SECONDS = 120.0


@contextlib.contextmanager
def serving(directory, *, executor=None, guarded=False):
    """Give the application and its address; a guarded one asks for keys, as if others could reach it."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]
    listening = Settings(data_dir=directory, port=port)
    app = create_app(
        listening.model_copy(update={"host": "0.0.0.0"}) if guarded else listening,  # noqa: S104  (not listened on)
        executor=executor,
    )
    server = Server(app, listening)
    thread = threading.Thread(target=server.run, daemon=True)
    thread.start()
    deadline = time.monotonic() + START_SECONDS
    while not server.started:
        assert thread.is_alive()
        assert time.monotonic() < deadline, "the service did not start"
        time.sleep(0.05)
    try:
        yield app, f"http://127.0.0.1:{port}"
    finally:
        server.should_exit = True
        thread.join(30.0)
