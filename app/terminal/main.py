"""Name every command and the module that holds it; nothing else is loaded before one is asked for."""

from typing import Annotated

import typer

from ..version import VERSION
from .guard import Commands
from .output.streams import say, speak_any_alphabet

HOMES = {
    "identify": "veritorque.app.terminal.commands.identify",
    "diagnose": "veritorque.app.terminal.commands.diagnose",
    "logs": "veritorque.app.terminal.commands.logs",
    "robots": "veritorque.app.terminal.commands.robots",
    "report": "veritorque.app.terminal.commands.report",
    "export": "veritorque.app.terminal.commands.export",
    "serve": "veritorque.app.terminal.commands.serve",
    "work": "veritorque.app.terminal.commands.work",
    "keys": "veritorque.app.terminal.commands.keys",
    "doctor": "veritorque.app.terminal.commands.upkeep",
    "backup": "veritorque.app.terminal.commands.upkeep",
    "restore": "veritorque.app.terminal.commands.upkeep",
    "gc": "veritorque.app.terminal.commands.upkeep",
    "openapi": "veritorque.app.terminal.commands.contract",
    "version": "veritorque.app.terminal.commands.contract",
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
    """Physically consistent dynamic identification of robots from their logs."""


def main() -> None:
    """Run the command line."""
    speak_any_alphabet()
    COMMANDS()
