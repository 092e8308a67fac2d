"""Offer operators what keeps a store healthy on the command line."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, NoReturn

import typer

from app.lifecycle.backup import NoBackup, back_up
from app.lifecycle.backup import restore as restore_backup
from app.lifecycle.doctor import examine
from app.lifecycle.retention import expire
from app.settings import Settings
from app.store.errors import Damaged, Unavailable
from app.store.store import Store
from app.store.sweep import Sweep

PAUSE_S = 20.0


def install(commands: typer.Typer) -> None:
    """Add the commands to a command line."""
    for command in (gc, backup, restore, doctor):
        commands.command()(command)


def gc(
    pause_s: Annotated[
        float, typer.Option(help="Between the two looks that find bytes needless, s.")
    ] = PAUSE_S,
) -> None:
    """Remove what has been kept long enough (VERITORQUE_RETENTION_DAYS), and bytes that nothing needs.

    The service may run meanwhile; it does the same by itself every minute.
    """
    settings = Settings()
    with _opened(settings) as store:
        for kind, count in expire(store.database, settings.retention_days).items():
            print(f"{count} {kind} expired")
        sweep = Sweep(store)
        sweep.look()
        time.sleep(pause_s)
        print(f"{sweep.look()} files removed that nothing needed")


def backup(directory: Annotated[Path, typer.Argument(help="A new directory for the backup.")]) -> None:
    """Copy everything into a new directory while the service runs."""
    with _opened(Settings()) as store:
        _say(back_up(store, directory))


def restore(directory: Annotated[Path, typer.Argument(help="The directory of a backup.")]) -> None:
    """Copy a backup into VERITORQUE_DATA_DIR (and VERITORQUE_DATABASE_URL), which has to be empty."""
    with _opened(Settings()) as store:
        _say(restore_backup(directory, store))


def doctor() -> None:
    """Examine database, files, permissions and disk, and say what to do; ends with 1 where harm is done."""
    harm = False
    for finding in examine(Settings()):
        harm |= finding.harm
        word = "WRONG" if finding.harm else "note" if finding.remedy else "ok"
        print(f"{word:6}{finding.subject}: {finding.seen}")
        if finding.remedy:
            print(f"      -> {finding.remedy}")
    if harm:
        raise typer.Exit(1)


@contextmanager
def _opened(settings: Settings) -> Iterator[Store]:
    try:
        store = Store(settings.data_dir, settings.database_url)
        try:
            yield store
        finally:
            store.close()
    except NoBackup as error:
        _stop(str(error))
    except Damaged as error:
        _stop(f"{error.sha256} is damaged: {error.evidence}; veritorque doctor says who needs it")
    except Unavailable as error:
        _stop(f"the database does not answer: {error.reason}; veritorque doctor says more")
    except OSError as error:
        _stop(f"{error.filename}: {error.strerror}; choose another directory or make room")


def _say(counts: dict[str, int]) -> None:
    print("copied " + ", ".join(f"{count} {name}" for name, count in counts.items()))


def _stop(reason: str) -> NoReturn:
    typer.echo(reason, err=True)
    raise typer.Exit(2)
