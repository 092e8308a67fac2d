"""Prepare what the service and its tools need: settings, a directory, the store."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import typer
from pydantic import ValidationError

from ..settings import PREFIX, Settings
from .output.exit_codes import Exit

if TYPE_CHECKING:
    from ..store.store import Store


def read_settings(**chosen: object) -> Settings:
    """Read the settings, those of the command line before those of the environment; or end."""
    try:
        return Settings.model_validate(Settings().model_dump() | chosen)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        stop(f"{'.'.join(str(step) for step in first['loc'])}: {first['msg']}")


@contextmanager
def open_store(settings: Settings) -> Iterator["Store"]:
    """Open what is kept, or say why that cannot be."""
    from ..store.errors import UnavailableError
    from ..store.store import Store

    try:
        store = Store(settings.data_dir, settings.database_url)
    except UnavailableError as error:
        stop(f"the database does not answer: {error.reason}; start it, or correct {PREFIX}DATABASE_URL")
    except ModuleNotFoundError as error:
        stop(f"PostgreSQL needs the package {error.name}: pip install 'veritorque[postgres]'")
    try:
        yield store
    finally:
        store.close()


def require_directory(data_dir: Path) -> None:
    """End where nothing can be kept in a directory."""
    try:
        data_dir.mkdir(parents=True, exist_ok=True)
        (data_dir / ".writable").touch()
        (data_dir / ".writable").unlink()
    except OSError as error:
        stop(f"nothing can be kept in {data_dir}: {error.strerror}; choose another --data-dir")


def stop(reason: str) -> NoReturn:
    """End because of what the operator asked for."""
    typer.echo(f"error: {reason}", err=True)
    raise typer.Exit(Exit.INPUT)
