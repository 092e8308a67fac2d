"""Run a computation from the command line and hand its result on: to the terminal, to programs, to files."""

import json
import signal
from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn

from .backend.protocol import Document, Study
from .backend.selection import open_backend
from .output.files import require_folder, save
from .output.streams import error_console, write


@dataclass(frozen=True)
class Destination:
    """Say where a result goes besides the terminal; with `json` the document goes there as it is."""

    json: bool
    out: Path | None
    report: Path | None


def run(study: Study, *, url: str, key: str, destination: Destination) -> Document:
    """Compute, save and print the result document as its destination says, and give it.

    Raises
    ------
    VeritorqueError
        Whatever stands in the way.
    """
    from ..client.progress import bar

    signal.signal(signal.SIGTERM, _interrupt)  # ends a job on a service as Ctrl-C does
    for path in (destination.out, destination.report):
        if path is not None:
            require_folder(path)
    with open_backend(url, key) as backend, bar(error_console()) as progress:
        content = backend.run(study, progress, destination.report)
    document: Document = json.loads(content)
    if destination.out is not None:
        save(destination.out, content)
    if destination.json:
        write(content)
    return document


def _interrupt(*_: object) -> NoReturn:
    raise KeyboardInterrupt
