"""Name every command and the module that holds it; nothing else is loaded before one is called."""

from importlib import import_module
from typing import Annotated, Any

import typer

from ..version import VERSION
from .guard import Commands
from .output.streams import echo, escape_unknown_characters

MODULES = {
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
    """Hold the commands of the kinds of job, then all others."""

    def list_commands(self, _ctx: Any) -> list[str]:  # noqa: ANN401  # typer's own type is private
        """List the commands in the order in which a reader meets them."""
        from ..kinds.registry import KINDS

        return [*KINDS, *MODULES]

    def load(self, name: str) -> typer.Typer | None:
        """Load a command; kinds of job are loaded only for theirs, and for names that are not known."""
        if name in MODULES:
            commands: typer.Typer = import_module(MODULES[name]).COMMANDS
            return commands
        from ..kinds.registry import KINDS
        from .commands.compute import command_of

        return command_of(name) if name in KINDS else None


COMMANDS = typer.Typer(
    name="veritorque",
    cls=_Veritorque,
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)


def _print_version(wanted: bool) -> None:  # noqa: FBT001  # as typer calls it
    if wanted:
        echo(VERSION)
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
    escape_unknown_characters()
    COMMANDS()
