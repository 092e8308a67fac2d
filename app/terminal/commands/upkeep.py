"""Offer operators what keeps a store healthy on the command line; only who runs it loads the database."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ...settings import Settings
from ..environment import read_settings, stop
from ..output.exit_codes import Exit
from ..output.streams import echo

if TYPE_CHECKING:
    from ...store.store import Store

PAUSE_S = 20.0
COMMANDS = typer.Typer(add_completion=False, rich_markup_mode=None)


@COMMANDS.command(epilog="\b\nExample:\n  veritorque gc --pause-s 1")
def gc(
    pause_s: Annotated[
        float, typer.Option(help="Interval between the two passes that find unreferenced files, s.")
    ] = PAUSE_S,
) -> None:
    """Remove what has expired (VERITORQUE_RETENTION_DAYS) and unreferenced files.

    The service may run meanwhile; it does the same by itself every minute.
    """
    from ...lifecycle.retention import expire
    from ...store.blobs.sweep import Sweep

    settings = read_settings()
    with _open_store(settings) as store:
        for kind, count in expire(store.database, settings.retention_days).items():
            echo(f"{count} {kind} expired")
        sweep = Sweep(store)
        sweep.run()
        time.sleep(pause_s)
        echo(f"{sweep.run()} unreferenced files removed")


@COMMANDS.command(epilog="\b\nExample:\n  veritorque backup backup-of-monday")
def backup(directory: Annotated[Path, typer.Argument(help="A new directory for the backup.")]) -> None:
    """Copy everything into a new directory while the service runs."""
    from ...lifecycle.backup import back_up

    with _open_store(read_settings()) as store:
        _print_counts(back_up(store, directory))


@COMMANDS.command(epilog="\b\nExample:\n  VERITORQUE_DATA_DIR=restored veritorque restore backup-of-sunday")
def restore(directory: Annotated[Path, typer.Argument(help="The directory of a backup.")]) -> None:
    """Copy a backup into VERITORQUE_DATA_DIR (and VERITORQUE_DATABASE_URL), which has to be empty."""
    from ...lifecycle import backup as backups

    with _open_store(read_settings()) as store:
        _print_counts(backups.restore(directory, store))


@COMMANDS.command(epilog="\b\nExample:\n  veritorque doctor")
def doctor() -> None:
    """Check database, files, permissions and disk, and print remedies; exits with code 1 on damage."""
    from ...lifecycle.doctor import examine

    harm = False
    for finding in examine(read_settings()):
        harm |= finding.harm
        word = "ERROR" if finding.harm else "note" if finding.remedy else "ok"
        echo(f"{word:6}{finding.subject}: {finding.seen}")
        if finding.remedy:
            echo(f"      -> {finding.remedy}")
    if harm:
        raise typer.Exit(Exit.FOUND)


@contextmanager
def _open_store(settings: Settings) -> Iterator["Store"]:
    from ...lifecycle.backup import NoBackupError
    from ...store.errors import DamagedError, UnavailableError
    from ...store.store import Store

    try:
        store = Store(settings.data_dir, settings.database_url)
        try:
            yield store
        finally:
            store.close()
    except NoBackupError as error:
        stop(str(error))
    except DamagedError as error:
        stop(f"{error.sha256} is damaged: {error.evidence}; veritorque doctor says who needs it")
    except UnavailableError as error:
        stop(f"the database does not answer: {error.reason}; veritorque doctor says more")
    except OSError as error:
        stop(f"{error.filename}: {error.strerror}; choose another directory or make room")


def _print_counts(counts: dict[str, int]) -> None:
    echo("copied " + ", ".join(f"{count} {name}" for name, count in counts.items()))
