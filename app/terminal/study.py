"""Run a computation from the command line and hand its result on: to the terminal, to programs, to files."""

import json
import signal
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, NoReturn

import typer

from app.terminal.bench import Document, Study, bench
from app.terminal.speech import aside, note, write
from core.errors import OptionError

OutOption = Annotated[Path | None, typer.Option(help="Save the result document here.")]
ReportOption = Annotated[Path | None, typer.Option(help="Save the report, one HTML file, here.")]


@dataclass(frozen=True)
class Wanted:
    """Say where a result goes besides the terminal; with `json` the document goes there as it is."""

    json: bool
    out: Path | None
    report: Path | None


def run(study: Study, *, url: str, key: str, wanted: Wanted) -> Document:
    """Compute, save what is wanted, and print the document where that is wanted; give it.

    Raises
    ------
    VeritorqueError
        Whatever stands in the way.
    """
    from app.client.progress import bar

    signal.signal(signal.SIGTERM, _interrupt)  # ends a job on a service as Ctrl-C does
    for path in (wanted.out, wanted.report):
        if path is not None:
            require_folder(path)
    with bench(url, key) as one, bar(aside()) as tell:
        content = one.run(study, tell)
    document: Document = json.loads(content)
    if wanted.out is not None:
        save(wanted.out, content)
    if wanted.report is not None:
        from core.report.page.page import compose_page

        save(wanted.report, compose_page(document).encode())
    if wanted.json:
        write(content)
    return document


def save(path: Path, content: bytes) -> None:
    """Write a file and say so.

    Raises
    ------
    OptionError
        If that cannot be.
    """
    try:
        path.write_bytes(content)
    except OSError as error:
        raise _unwritable(path, error.strerror or "") from error
    note(f"saved {path}")


def require_folder(path: Path) -> None:
    """Return where a file could be written, before an hour is spent on what goes into it.

    Raises
    ------
    OptionError
        If its folder is not there, or the file is a folder.
    """
    if path.is_dir() or not path.parent.is_dir():
        raise _unwritable(path, "it is a folder" if path.is_dir() else "its folder is not there")


def _unwritable(path: Path, reason: str) -> OptionError:
    return OptionError(
        f"{path} cannot be written",
        evidence={"reason": reason},
        remedy="name a file in a folder that is there",
    )


def _interrupt(*_: object) -> NoReturn:
    raise KeyboardInterrupt
