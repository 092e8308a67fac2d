"""List, show and check robots before a motion is run on one."""

from typing import Annotated, Any

import typer

from app.documents import json_bytes
from app.terminal.bench import FromUrdf, bench
from app.terminal.exits import Exit
from app.terminal.given import JsonOption, KeyOption, RobotArgument, UrlOption
from app.terminal.speech import out, say, write
from core.errors import RobotError

COMMANDS = typer.Typer(
    help="List, show and check robots.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    epilog="\b\nExample:\n  veritorque robots list",
)
BaseLinkOption = Annotated[str, typer.Option(help="Of a URDF: the link that stands still.")]
TipLinkOption = Annotated[str, typer.Option(help="Of a URDF: the last link that is meant.")]
GravityOption = Annotated[str, typer.Option(help="Of a URDF: x,y,z in m/s2 in the base frame.")]
GEOMETRY = ("alpha", "d", "theta_offset", "r", "gamma", "b")


@COMMANDS.command(name="list", epilog="\b\nExample:\n  veritorque robots list")
def list_robots(*, url: UrlOption = "", key: KeyOption = "", json: JsonOption = False) -> None:
    """List the robots that need no description."""
    with bench(url, key) as one:
        robots = one.robots()
    if json:
        write(json_bytes(robots))
        return
    for robot in robots:
        say(f"{robot['id']:<16}  {robot['joints']:>2} joints  {robot['name']}")


@COMMANDS.command(
    epilog="\b\nExamples:\n  veritorque robots show yumi-left\n  veritorque robots show yumi --json"
)
def show(  # noqa: PLR0913  # the options of a command line
    robot: RobotArgument,
    *,
    base_link: BaseLinkOption = "",
    tip_link: TipLinkOption = "",
    gravity: GravityOption = "",
    url: UrlOption = "",
    key: KeyOption = "",
    json: JsonOption = False,
) -> None:
    """Show a robot as it is understood; with --json its description, which a URDF becomes as well."""
    part = FromUrdf(base_link or None, tip_link or None, _vector(gravity))
    with bench(url, key) as one:
        seen = one.robot(robot, part)
    if json:
        write(json_bytes(seen["description"]))
        return
    say(f"{seen['name']}: {seen['joints']} joints, gravity {_listed(seen['description']['gravity'])} m/s2")
    out().print(_joint_table(seen["description"]))
    _tell_suspicions(seen)


@COMMANDS.command(epilog="\b\nExample:\n  veritorque robots check examples/yumi/robot.json")
def check(
    robot: RobotArgument,
    *,
    fail_on_findings: Annotated[
        bool, typer.Option("--fail-on-findings", help="End with 1 where something looks like a mistake.")
    ] = False,
    url: UrlOption = "",
    key: KeyOption = "",
) -> None:
    """Check a description: what cannot be used is an error, what is rarely meant is told with its numbers."""
    with bench(url, key) as one:
        seen = one.robot(robot)
    say(f"{seen['name']}: {seen['joints']} joints; it can be used")
    _tell_suspicions(seen)
    if fail_on_findings and seen["suspicions"]:
        raise typer.Exit(Exit.FOUND)


@COMMANDS.command(epilog="\b\nExample:\n  veritorque robots base-parameters yumi-left")
def base_parameters(
    robot: RobotArgument, *, url: UrlOption = "", key: KeyOption = "", json: JsonOption = False
) -> None:
    """List the combinations of parameters that a motion of the robot can tell apart, with their groupings."""
    with bench(url, key) as one:
        document = one.base_parameters(robot)
    if json:
        write(json_bytes(document))
        return
    counts = document["counts"]
    say(f"{counts['standard']} standard parameters, {counts['base']} base parameters")
    for row in document["base_parameters"]:
        say(f"{row['name']:<8}{row['unit']:<12}{row['grouping']}")
    if document["without_effect"]:
        say(f"without effect on the torque: {', '.join(document['without_effect'])}")


def _joint_table(description: dict[str, Any]) -> Any:  # noqa: ANN401  # rich is loaded when something is drawn
    from rich.box import SIMPLE_HEAD
    from rich.table import Table

    table = Table(box=SIMPLE_HEAD, padding=(0, 1, 0, 0))
    rows = description["joints"]
    shown = [name for name in GEOMETRY if any(row.get(name) for row in rows)]
    for heading in ("joint", "name", "type", "on", *shown, "position"):
        table.add_column(heading, justify="left" if heading in ("name", "type") else "right")
    for place, row in enumerate(rows, start=1):
        limits = (row.get("limits") or {}).get("position")
        table.add_row(
            str(place),
            str(row.get("name", "")),
            str(row.get("type", "")) + (f", mimics {row['mimics']}" if row.get("mimics") else ""),
            str(row.get("antecedent", "")),
            *(f"{row.get(name) or 0.0:.4g}" for name in shown),
            "" if limits is None else f"{limits[0]:.4g} .. {limits[1]:.4g}",
        )
    return table


def _tell_suspicions(seen: dict[str, Any]) -> None:
    for one in seen["suspicions"]:
        say(f"rarely meant: {one}")


def _listed(values: list[float]) -> str:
    return ", ".join(f"{value:.4g}" for value in values)


def _vector(text: str) -> tuple[float, ...] | None:
    if not text:
        return None
    try:
        parts = tuple(float(part) for part in text.split(","))
    except ValueError:
        parts = ()
    if len(parts) != 3:
        raise RobotError(
            "gravity is not three numbers", evidence={"given": text}, remedy="write --gravity=0,0,-9.81"
        )
    return parts
