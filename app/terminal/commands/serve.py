"""Start the service from a terminal; every setting can also stand in the environment.

Source of the names: `app.settings`.
"""

import socket
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ...settings import PREFIX, Settings
from ..computing import COMPILING, keep_compiled_kernels, limit_threads
from ..environment import open_store, read_settings, require_directory, stop
from ..output.streams import echo

if TYPE_CHECKING:
    from ...store.store import Store

DEFAULTS = Settings.model_construct()
OPTIONS = ("host", "port", "data_dir", "workers", "max_upload_bytes", "job_timeout_s")
"""Settings that are options, too."""
OTHERS = ", ".join(PREFIX + name.upper() for name in Settings.model_fields if name not in OPTIONS)
EPILOG = f"""\b
Examples:
  veritorque serve
  veritorque serve --port 9000 --data-dir lab-data

In the environment, besides these: {OTHERS}"""

COMMANDS = typer.Typer(add_completion=False, rich_markup_mode=None)


@COMMANDS.command(epilog=EPILOG)
def serve(
    host: Annotated[str, typer.Option(envvar=PREFIX + "HOST", help="Address to listen on.")] = DEFAULTS.host,
    port: Annotated[int, typer.Option(envvar=PREFIX + "PORT", help="Port to listen on.")] = DEFAULTS.port,
    data_dir: Annotated[
        Path,
        typer.Option(envvar=PREFIX + "DATA_DIR", help="Directory of logs, results and compiled kernels."),
    ] = DEFAULTS.data_dir,
    workers: Annotated[
        int, typer.Option(envvar=PREFIX + "WORKERS", help="Number of parallel computations.")
    ] = DEFAULTS.workers,
    max_upload_bytes: Annotated[
        int, typer.Option(envvar=PREFIX + "MAX_UPLOAD_BYTES", help="Maximum size of an uploaded log, bytes.")
    ] = DEFAULTS.max_upload_bytes,
    job_timeout_s: Annotated[
        float, typer.Option(envvar=PREFIX + "JOB_TIMEOUT_S", help="Time limit of a computation, s.")
    ] = DEFAULTS.job_timeout_s,
) -> None:
    """Start the service.

    On loopback no key is needed. On any other address it starts only where there is one: veritorque keys
    create.
    """
    settings = read_settings(
        host=host,
        port=port,
        data_dir=data_dir,
        workers=workers,
        max_upload_bytes=max_upload_bytes,
        job_timeout_s=job_timeout_s,
    )
    require_directory(settings.data_dir)
    limit_threads(settings.job_cpus)
    _require_to_be_alone(settings.data_dir)
    with open_store(settings) as store:
        if settings.needs_keys:
            _require_a_key(store, settings.host)
    kernels = keep_compiled_kernels(settings.data_dir)
    if kernels is not None:
        echo(f"compiling once, {COMPILING} (kept in {kernels}); jobs wait for it")
    _listen(settings)


def _require_a_key(store: "Store", host: str) -> None:
    from ...auth.keys import KeyRing

    if not KeyRing(store.database).any():
        stop(
            f"{host} can be reached from other machines, and there is no key yet; make one with "
            "`veritorque keys create NAME`, or keep --host 127.0.0.1"
        )


def _require_to_be_alone(data_dir: Path) -> None:
    from ...store.lock import DirectoryInUseError, DirectoryLock

    try:
        DirectoryLock(data_dir).release()
    except DirectoryInUseError:
        stop(f"another service uses {data_dir}; stop it, or choose another --data-dir")


def _require_free(host: str, port: int) -> None:
    try:
        family, kind, *_, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
        with socket.socket(family, kind) as listener:
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            listener.bind(address)
    except OSError as error:
        stop(f"nothing can listen on {host}, port {port}: {error.strerror}; choose another --host or --port")


def _listen(settings: Settings) -> None:
    from ...http.server import Server
    from ...jobs.supervisor import Supervisor
    from ...logging import configure_logging
    from ...main import create_app
    from ...services.metrics import Metrics

    _require_free(settings.host, settings.port)
    configure_logging(settings)
    shown = f"[{settings.host}]" if ":" in settings.host else settings.host
    echo(f"http://{shown}:{settings.port}/docs")
    metrics = Metrics()
    supervisor = Supervisor(settings, on_ended=metrics.ended) if settings.workers else None
    with suppress(KeyboardInterrupt):
        Server(create_app(settings, supervisor=supervisor, metrics=metrics), settings).run()
