"""Look at logs before anything is identified from them; no solver is loaded for that."""

import json as encoder
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ....core.errors import LogError
from ..options import JsonOption, MappingOption, ProfileOption, mapping_of
from ..output.exit_codes import Exit
from ..output.streams import complain, note, say

if TYPE_CHECKING:
    from ....core.log.check import LogCheck

COMMANDS = typer.Typer(
    help="Look at logs before anything is identified from them.",
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
        bool, typer.Option("--fail-on-defects", help="End with 1 where a log has defects.")
    ] = False,
    json: JsonOption = False,
) -> None:
    """Say what is in a log and what is wrong with it: columns, units, rate, gaps, outliers, saturation ..."""
    from ..output.logcheck import document_of, lines_of
    from ..threads import limit_threads

    limit_threads(1)
    chosen = mapping_of(mapping, profile)
    checks = [(path, _look(path, chosen)) for path in logs]
    documents = [document_of(path, seen) for path, seen in checks]
    if json:
        say(encoder.dumps(documents if len(documents) > 1 else documents[0]))
    for path, seen in checks:
        for line in () if json else lines_of(path, seen):
            say(line)
        _tell_of(path, seen)
    if any(seen.refusal is not None for _, seen in checks):
        raise typer.Exit(Exit.INPUT)
    if fail_on_defects and any(document["defects"] for document in documents):
        raise typer.Exit(Exit.FOUND)


def _tell_of(path: Path, seen: "LogCheck") -> None:
    """Say beside the result why a log cannot be used, and which mapping might mend it."""
    why = "the sizes suggest these units; believe the recorder rather than this"
    if seen.refusal is not None:
        complain(seen.refusal.cause, _of(path, seen.refusal), seen.refusal.remedy)
        why = "the names suggest this; look at the units before you believe it"
    if seen.suggestion is not None:
        written = encoder.dumps(seen.suggestion)
        unknown = ', and write for "?" what the recorder knows' if '"?"' in written else ""
        note(f"  {why}{unknown}:")
        note(f"  --mapping '{written}'")


def _look(path: Path, mapping: dict[str, Any] | None) -> "LogCheck":
    from ....core.log.check import check_log

    try:
        return check_log(path, mapping=mapping)
    except LogError as error:
        raise LogError(error.cause, evidence=_of(path, error), remedy=error.remedy) from error


def _of(path: Path, error: LogError) -> dict[str, Any]:
    """Give what was seen, with the log in which it was: there may be several."""
    return {"log": path.name, **error.evidence}
