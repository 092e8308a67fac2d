"""Make, list and revoke the keys of a service, where its data are kept."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated

import typer

from ...settings import LOCAL, SCOPES
from ..environment import open_store, read_settings, require_directory, stop
from ..output.streams import echo

if TYPE_CHECKING:
    from ...store.keys import KeyStore

COMMANDS = typer.Typer(
    help="Create, list and revoke keys of a service.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    epilog="\b\nExample:\n  veritorque keys list",
)
ScopesOption = Annotated[str, typer.Option(help="Scopes, separated by commas: read, write, admin.")]


@COMMANDS.command(epilog="\b\nExample:\n  veritorque keys create my-notebook --scopes read,write")
def create(
    name: Annotated[str, typer.Argument(help="Name of the key, for your records.")],
    tenant: Annotated[str, typer.Option(help="Tenant whose robots, logs and jobs it can access.")] = LOCAL,
    scopes: ScopesOption = "read,write",
) -> None:
    """Create a key and print its secret, which is not stored and cannot be shown again."""
    wanted = tuple(scope.strip() for scope in scopes.split(",") if scope.strip())
    unknown = sorted(set(wanted) - set(SCOPES))
    if unknown or not wanted:
        stop(f"there is no scope {', '.join(unknown) or '(none)'}; the scopes are {', '.join(SCOPES)}")
    with _keys() as keys:
        _, secret = keys.create(tenant=tenant, name=name, scopes=wanted)
    echo(secret)


@COMMANDS.command(name="list", epilog="\b\nExample:\n  veritorque keys list")
def list_keys() -> None:
    """List all keys: id, tenant, name, scopes, and since when they are valid or were revoked."""
    with _keys() as keys:
        for record in keys.all():
            since = f"revoked {record.revoked_at}" if record.revoked_at else f"since {record.created_at}"
            echo(f"{record.id}  {record.tenant}  {record.name}  {','.join(record.scopes)}  {since}")


@COMMANDS.command(epilog="\b\nExample:\n  veritorque keys revoke 3f2a91")
def revoke(identity: Annotated[str, typer.Argument(help="The id that `keys list` shows.")]) -> None:
    """Revoke a key; a running service refuses it within seconds."""
    with _keys() as keys:
        if not keys.revoke(identity):
            stop(f"there is no valid key {identity}; `veritorque keys list` shows all")


@contextmanager
def _keys() -> Iterator["KeyStore"]:
    from ...store.keys import KeyStore

    settings = read_settings()
    require_directory(settings.data_dir)
    with open_store(settings) as store:
        yield KeyStore(store.database)
