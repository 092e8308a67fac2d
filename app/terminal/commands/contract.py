"""Print what the service is: its contract and its version."""

import typer

from ...version import VERSION
from ..output.streams import echo

COMMANDS = typer.Typer(add_completion=False, rich_markup_mode=None)


@COMMANDS.command(epilog="\b\nExample:\n  veritorque openapi > openapi.json")
def openapi() -> None:
    """Print the contract as OpenAPI 3.1."""
    import json

    from ...main import create_app
    from ...settings import Settings

    echo(json.dumps(create_app(Settings.model_construct()).openapi(), indent=2))


@COMMANDS.command(epilog="\b\nExample:\n  veritorque version")
def version() -> None:
    """Print the version."""
    echo(VERSION)
