"""Export the identified robot as files for other tools."""

from pathlib import Path
from typing import Annotated

import typer

from ....core.errors import OptionError
from ....core.export.formats import FORMATS
from ...services.export_files import TRACES_FILE, TRACES_TYPE
from ..options import KeyOption, UrlOption
from ..output.files import means_a_file, require_folder, save
from ..output.streams import echo, write
from ..results import RESULT_HELP, read_result

COMMANDS = typer.Typer(add_completion=False, rich_markup_mode=None)
TRACES_TITLE = "torques and residuals of every sample, of a job (--url)"
EPILOG = "\b\nExamples:\n  veritorque export result.json robot.urdf\n" + (
    "  veritorque export result.json robot.xml --out yumi.xml\n"
    "  veritorque export 5f0c1d9e residuals.parquet --url http://127.0.0.1:8000\n"
    "  veritorque export --list\n\n\b\nFormats:\n"
    + "\n".join(f"  {name:<24}{form.title}" for name, form in FORMATS.items())
    + f"\n  {TRACES_FILE:<24}{TRACES_TITLE}\n"
)


def _print_list(wanted: bool) -> None:  # noqa: FBT001  # as typer calls it
    if wanted:
        for name, form in FORMATS.items():
            echo(f"{name:<24}{form.media_type:<34}{form.title}")
        echo(f"{TRACES_FILE:<24}{TRACES_TYPE:<34}{TRACES_TITLE}")
        raise typer.Exit


@COMMANDS.command(epilog=EPILOG)
def export(
    result: Annotated[str, typer.Argument(metavar="RESULT", help=RESULT_HELP)],
    name: Annotated[str, typer.Argument(metavar="FORMAT", help="One of the formats below.")],
    *,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Output file, - for the terminal; default: a file of this name."),
    ] = None,
    url: UrlOption = "",
    key: KeyOption = "",
    _list: Annotated[
        bool, typer.Option("--list", callback=_print_list, is_eager=True, help="List the formats.")
    ] = False,
) -> None:
    """Write the identified robot as URDF, MJCF, SDFormat, YAML, CSV, MATLAB, C, or a model file."""
    if name not in (*FORMATS, TRACES_FILE):
        raise OptionError(
            f"there is no format {name}",
            evidence={"known": [*FORMATS, TRACES_FILE]},
            remedy="name one of the known formats; --out sets the output file",
        )
    target = out or Path(name)
    if str(target) != "-":
        require_folder(target)
    content = _content(result, name, url, key)
    if str(target) == "-":
        write(content)
    else:
        save(target, content)


def _content(result: str, name: str, url: str, key: str) -> bytes:
    if url and not means_a_file(result):
        from ...client.client import Client

        with Client(url, key or None) as client:
            return client.export(result, name)
    document = read_result(result)
    if name == TRACES_FILE:
        raise OptionError(
            f"{result} holds no torque traces",
            evidence={"asked_for": name, "kind": document["kind"]},
            remedy="give --url and the id of a job, whose traces are stored, or use `identify --report`",
        )
    return FORMATS[name].write(document)
