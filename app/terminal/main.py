"""Name every command and the module that holds it; nothing else is loaded before one is asked for."""

from typing import Annotated

import typer

from app.terminal.guard import Commands
from app.terminal.output.streams import say, speak_any_alphabet
from app.version import VERSION

HOMES = {
    "identify": "app.terminal.commands.identify",
    "diagnose": "app.terminal.commands.diagnose",
    "logs": "app.terminal.commands.logs",
    "robots": "app.terminal.commands.robots",
    "report": "app.terminal.commands.report",
    "export": "app.terminal.commands.export",
    "serve": "app.terminal.commands.serve",
    "work": "app.terminal.commands.work",
    "keys": "app.terminal.commands.keys",
    "doctor": "app.terminal.commands.upkeep",
    "backup": "app.terminal.commands.upkeep",
    "restore": "app.terminal.commands.upkeep",
    "gc": "app.terminal.commands.upkeep",
    "openapi": "app.terminal.commands.contract",
    "version": "app.terminal.commands.contract",
}


class _Veritorque(Commands):
    homes = HOMES


COMMANDS = typer.Typer(
    name="veritorque",
    cls=_Veritorque,
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)


def _print_version(wanted: bool) -> None:  # noqa: FBT001  # as typer calls it
    if wanted:
        say(VERSION)
        raise typer.Exit


@COMMANDS.callback(epilog="\b\nExample:\n  veritorque identify yumi-left examples/yumi/log.csv")
def _veritorque(
    *,
    _version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    """From a robot's log to a robot that can physically exist."""


def main() -> None:
    """Run the command line."""
    speak_any_alphabet()
    COMMANDS()
