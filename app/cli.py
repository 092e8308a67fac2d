"""Offer the service on the command line; every setting can also stand in the environment.

Source of the names: `app.settings`.
"""

import json
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer
from pydantic import ValidationError

from app.settings import LOCAL, PREFIX, SCOPES, Settings
from app.version import VERSION

if TYPE_CHECKING:
    from app.store.keys import KeyStore
    from app.store.store import Store

COMPILE_SECONDS = 5
DEFAULTS = Settings.model_construct()

OPTIONS = ("host", "port", "data_dir", "workers", "max_upload_bytes", "job_timeout_s")
"""Settings that are options, too."""


def _others() -> str:
    """Name the settings that only stand in the environment."""
    names = (PREFIX + name.upper() for name in Settings.model_fields if name not in OPTIONS)
    return "In the environment, besides these: " + ", ".join(names)


COMMANDS = typer.Typer(
    name="veritorque",
    help="From a robot's log to a robot that can physically exist.",
    no_args_is_help=True,
    add_completion=False,
)


def main() -> None:
    """Run the command line."""
    from app.lifecycle.commands import install

    install(COMMANDS)
    COMMANDS()


@COMMANDS.command(epilog=_others())
def serve(
    host: Annotated[str, typer.Option(envvar=PREFIX + "HOST", help="Address to listen on.")] = DEFAULTS.host,
    port: Annotated[int, typer.Option(envvar=PREFIX + "PORT", help="Port to listen on.")] = DEFAULTS.port,
    data_dir: Annotated[
        Path,
        typer.Option(envvar=PREFIX + "DATA_DIR", help="Where logs, results and compiled kernels are kept."),
    ] = DEFAULTS.data_dir,
    workers: Annotated[
        int, typer.Option(envvar=PREFIX + "WORKERS", help="Computations at the same time.")
    ] = DEFAULTS.workers,
    max_upload_bytes: Annotated[
        int, typer.Option(envvar=PREFIX + "MAX_UPLOAD_BYTES", help="Largest log taken.")
    ] = DEFAULTS.max_upload_bytes,
    job_timeout_s: Annotated[
        float, typer.Option(envvar=PREFIX + "JOB_TIMEOUT_S", help="Longest computation, s.")
    ] = DEFAULTS.job_timeout_s,
) -> None:
    """Start the service.

    On loopback no key is needed. On any other address it starts only where there is one: veritorque keys
    create.
    """
    settings = _settings(
        host=host,
        port=port,
        data_dir=data_dir,
        workers=workers,
        max_upload_bytes=max_upload_bytes,
        job_timeout_s=job_timeout_s,
    )
    _require_directory(settings.data_dir)
    _limit_threads(settings.job_cpus)
    _require_to_be_alone(settings.data_dir)
    with _opened(settings) as store:
        if settings.needs_keys:
            _require_a_key(store, settings.host)
    _keep_compiled_kernels(settings.data_dir)
    _listen(settings)


@COMMANDS.command()
def work(
    *,
    beside: Annotated[
        bool, typer.Option(hidden=True, help="Say that it lives, and end with the service.")
    ] = False,
) -> None:
    """Compute jobs in this process, beside the service or on another machine.

    It needs the same VERITORQUE_DATABASE_URL and the same VERITORQUE_DATA_DIR as the service.
    """
    settings = _settings()
    _require_directory(settings.data_dir)
    _limit_threads(settings.job_cpus)
    _keep_compiled_kernels(settings.data_dir)
    from app.jobs.process import work_until_told
    from app.journal import open_journal

    open_journal(settings)
    with _opened(settings) as store:
        work_until_told(store, settings, beside=beside)


KEYS = typer.Typer(help="Make, list and revoke API keys.", no_args_is_help=True)
COMMANDS.add_typer(KEYS, name="keys")
ScopesOption = Annotated[str, typer.Option(help="What it permits: read, write and admin, with commas.")]


@KEYS.command()
def create(
    name: Annotated[str, typer.Argument(help="Whose key it is, for your own records.")],
    tenant: Annotated[str, typer.Option(help="Whose robots, logs and jobs it opens.")] = LOCAL,
    scopes: ScopesOption = "read,write",
) -> None:
    """Make a key and print its secret, which is not kept and cannot be shown again."""
    wanted = tuple(one.strip() for one in scopes.split(",") if one.strip())
    unknown = sorted(set(wanted) - set(SCOPES))
    if unknown or not wanted:
        _stop(f"there is no scope {', '.join(unknown) or '(none)'}; the scopes are {', '.join(SCOPES)}")
    with _keys() as keys:
        _, secret = keys.create(tenant=tenant, name=name, scopes=wanted)
    print(secret)


@KEYS.command(name="list")
def list_keys() -> None:
    """List all keys: id, tenant, name, scopes, and since when they are valid or were revoked."""
    with _keys() as keys:
        for one in keys.all():
            since = f"revoked {one.revoked_at}" if one.revoked_at else f"since {one.created_at}"
            print(f"{one.id}  {one.tenant}  {one.name}  {','.join(one.scopes)}  {since}")


@KEYS.command()
def revoke(identity: Annotated[str, typer.Argument(help="The id that `keys list` shows.")]) -> None:
    """Revoke a key; a running service refuses it within seconds."""
    with _keys() as keys:
        if not keys.revoke(identity):
            _stop(f"there is no valid key {identity}; `veritorque keys list` shows all")


@contextmanager
def _keys() -> Iterator["KeyStore"]:
    from app.store.keys import KeyStore

    settings = _settings()
    _require_directory(settings.data_dir)
    with _opened(settings) as store:
        yield KeyStore(store.database)


@contextmanager
def _opened(settings: Settings) -> Iterator["Store"]:
    """Open what is kept, or say why that cannot be."""
    from app.store.errors import Unavailable
    from app.store.store import Store

    try:
        store = Store(settings.data_dir, settings.database_url)
    except Unavailable as error:
        _stop(f"the database does not answer: {error.reason}; start it, or correct {PREFIX}DATABASE_URL")
    except ModuleNotFoundError as error:
        _stop(f"PostgreSQL needs the package {error.name}: pip install 'veritorque[postgres]'")
    try:
        yield store
    finally:
        store.close()


@COMMANDS.command()
def openapi() -> None:
    """Print the contract as OpenAPI 3.1."""
    from app.main import create_app

    print(json.dumps(create_app(Settings.model_construct()).openapi(), indent=2))


@COMMANDS.command()
def version() -> None:
    """Print the version."""
    print(VERSION)


def _settings(**chosen: object) -> Settings:
    try:
        return Settings.model_validate(Settings().model_dump() | chosen)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        _stop(f"{'.'.join(str(step) for step in first['loc'])}: {first['msg']}")


def _require_a_key(store: "Store", host: str) -> None:
    from app.keys import KeyRing

    if not KeyRing(store.database).any():
        _stop(
            f"{host} can be reached from other machines, and there is no key yet; make one with "
            "`veritorque keys create NAME`, or keep --host 127.0.0.1"
        )


def _require_directory(data_dir: Path) -> None:
    try:
        data_dir.mkdir(parents=True, exist_ok=True)
        (data_dir / ".writable").touch()
        (data_dir / ".writable").unlink()
    except OSError as error:
        _stop(f"nothing can be kept in {data_dir}: {error.strerror}; choose another --data-dir")


def _require_to_be_alone(data_dir: Path) -> None:
    from app.store.lock import DirectoryInUse, DirectoryLock

    try:
        DirectoryLock(data_dir).release()
    except DirectoryInUse:
        _stop(f"another service uses {data_dir}; stop it, or choose another --data-dir")


def _limit_threads(cpus: int) -> None:
    """Let linear algebra use a thread per CPU of a computation, unless the operator has decided otherwise.

    The matrices are small: more threads double the CPU time of a job, wait for each other on a busy machine,
    and add numbers in an order that depends on their count. Arrow shall not reserve memory that it does not
    use, because what a computation may use is counted. It has to stand before numpy is loaded.
    """
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(name, str(cpus))
    os.environ.setdefault("ARROW_DEFAULT_MEMORY_POOL", "system")


def _keep_compiled_kernels(data_dir: Path) -> None:
    """Let numba keep what it compiles in the data directory, and say so where it has not compiled yet."""
    kernels = Path(os.environ.setdefault("NUMBA_CACHE_DIR", str((data_dir / "kernels").resolve())))
    if not any(kernels.rglob("*.nbi")):
        print(
            f"compiling the regressor once, about {COMPILE_SECONDS} s (kept in {kernels}); jobs wait for it"
        )


def _listen(settings: Settings) -> None:
    from app.jobs.supervisor import Supervisor
    from app.journal import open_journal
    from app.main import create_app
    from app.metrics import Metrics
    from app.server import Server

    open_journal(settings)
    shown = f"[{settings.host}]" if ":" in settings.host else settings.host
    print(f"http://{shown}:{settings.port}/docs", flush=True)
    metrics = Metrics()
    supervisor = Supervisor(settings, told=metrics.ended) if settings.workers else None
    with suppress(KeyboardInterrupt):
        Server(create_app(settings, supervisor=supervisor, metrics=metrics), settings).run()


def _stop(reason: str) -> NoReturn:
    typer.echo(reason, err=True)
    raise typer.Exit(2)
