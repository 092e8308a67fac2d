"""Write the report of a result: one HTML file that opens offline."""

from pathlib import Path
from typing import Annotated

import typer

from ..options import KeyOption, UrlOption
from ..output.files import means_a_file, require_folder, save
from ..output.streams import note
from ..results import RESULT_HELP, read_result

COMMANDS = typer.Typer(add_completion=False, rich_markup_mode=None)
EPILOG = """\b
Examples:
  veritorque report result.json --out report.html
  veritorque report 5f0c1d9e --url http://127.0.0.1:8000 --out report.html
"""


@COMMANDS.command(epilog=EPILOG)
def report(
    result: Annotated[str, typer.Argument(metavar="RESULT", help=RESULT_HELP)],
    *,
    out: Annotated[Path, typer.Option("--out", "-o", help="Output file.")] = Path("report.html"),
    url: UrlOption = "",
    key: KeyOption = "",
) -> None:
    """Write the report of a result: figures, tables and sentences in one HTML file that opens offline."""
    require_folder(out)
    if url and not means_a_file(result):
        from ...client.client import Client

        with Client(url, key or None) as client:
            save(out, client.report(result))
        return
    from ....core.report.page.page import compose_page

    save(out, compose_page(read_result(result)).encode())
    note("without torque traces, which a result file does not hold: use identify --report or a job (--url)")
