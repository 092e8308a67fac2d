"""Run a computation from the command line and hand its result on: to the terminal, to programs, to files."""

import json
import signal
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, NoReturn

import typer

from .backend.protocol import Document, Study, bench
from .output.files import require_folder, save
from .output.streams import aside, write

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
    from ..client.progress import bar

    signal.signal(signal.SIGTERM, _interrupt)  # ends a job on a service as Ctrl-C does
    for path in (wanted.out, wanted.report):
        if path is not None:
            require_folder(path)
    with bench(url, key) as one, bar(aside()) as tell:
        content = one.run(study, tell, wanted.report)
    document: Document = json.loads(content)
    if wanted.out is not None:
        save(wanted.out, content)
    if wanted.json:
        write(content)
    return document


def _interrupt(*_: object) -> NoReturn:
    raise KeyboardInterrupt
