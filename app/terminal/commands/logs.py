"""Check logs before identification; no solver is loaded."""

import json as encoder
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ....core.errors import LogError
from ..options import JsonOption, MappingOption, ProfileOption, mapping_of
from ..output.exit_codes import Exit
from ..output.files import require_folder
from ..output.streams import complain, echo, note

if TYPE_CHECKING:
    from ....core.log.check import LogCheck

COMMANDS = typer.Typer(
    help="Check logs before identification.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    epilog="\b\nExample:\n  veritorque logs check examples/yumi/log.csv",
)
EPILOG = """\b
Examples:
  veritorque logs check examples/yumi/log.csv
  veritorque logs check examples/yumi/log.csv --fail-on-defects --json
"""

UNKNOWN = '"?"'
OPEN = (
    ', and replace "?" (the scale of a motor\'s angle or speed is 1 / gear ratio, that of its torque the '
    "gear ratio)"
)
JOIN_EPILOG = """\b
Example:
  veritorque logs join positions.csv torques.csv -o run.parquet
"""


@COMMANDS.callback()
def _logs() -> None:
    pass


@COMMANDS.command(epilog=EPILOG)
def check(
    logs: Annotated[list[Path], typer.Argument(metavar="LOG...", help="Logs in any format.")],
    *,
    mapping: MappingOption = "",
    profile: ProfileOption = "",
    fail_on_defects: Annotated[
        bool, typer.Option("--fail-on-defects", help="Exit with code 1 if a log has defects.")
    ] = False,
    json: JsonOption = False,
) -> None:
    """Show columns, units, rate and defects of a log: gaps, outliers, saturation ..."""
    from ..computing import limit_threads
    from ..output.logcheck import document_of, lines_of

    limit_threads(1)
    chosen = mapping_of(mapping, profile)
    checks = [(path, _check(path, chosen)) for path in logs]
    documents = [document_of(path, seen) for path, seen in checks]
    if json:
        echo(encoder.dumps(documents if len(documents) > 1 else documents[0]))
    for path, seen in checks:
        if not json:
            echo("\n".join(lines_of(path, seen)))
        _print_suggestion(path, seen)
    _end(checks, fail_on_defects=fail_on_defects)


def _end(checks: list[tuple[Path, "LogCheck"]], *, fail_on_defects: bool) -> None:
    """End with the exit code that the checks call for."""
    if any(seen.refusal is not None for _, seen in checks):
        raise typer.Exit(Exit.INPUT)
    if fail_on_defects and any(seen.log is not None and seen.log.defects for _, seen in checks):
        raise typer.Exit(Exit.FOUND)


@COMMANDS.command(epilog=JOIN_EPILOG)
def join(
    logs: Annotated[list[Path], typer.Argument(metavar="LOG...", help="Files of one run, with stamps.")],
    *,
    output: Annotated[Path, typer.Option("--output", "-o", help="Parquet file to write.")],
) -> None:
    """Join files of one run, or the channels of one file that were recorded at instants of their own."""
    from ....core.log.joining import join_logs
    from ..computing import limit_threads

    limit_threads(1)
    require_folder(output)
    joined = join_logs(logs)
    joined.save(output)
    for line in joined.notes:
        note(f"  {line}")
    rows = len(next(iter(joined.columns.values())))
    echo(f"{output}: {rows} rows, {len(joined.columns)} columns: {', '.join(joined.columns)}")


def _print_suggestion(path: Path, seen: "LogCheck") -> None:
    """Print why a log is invalid, and a mapping that may correct it."""
    why = "suggested by the ranges; check the units against the recorder"
    if seen.refusal is not None:
        complain(seen.refusal.cause, _of(path, seen.refusal), seen.refusal.remedy)
        why = "suggested by the columns; check the units and the order of the joints"
    if seen.suggestion is not None:
        written = encoder.dumps(seen.suggestion)
        note(f"  {why}{OPEN if UNKNOWN in written else ''}:")
        note(f"  --mapping '{written}'")
    for other in seen.other_arms:
        note("  for another arm in the same file, as a log of its own:")
        note(f"  --mapping '{encoder.dumps(other)}'")


def _check(path: Path, mapping: dict[str, Any] | None) -> "LogCheck":
    from ....core.log.check import check_log

    try:
        return check_log(path, mapping=mapping)
    except LogError as error:
        raise LogError(error.cause, evidence=_of(path, error), remedy=error.remedy) from error


def _of(path: Path, error: LogError) -> dict[str, Any]:
    """Give the evidence with the name of the log."""
    return {"log": path.name, **error.evidence}
