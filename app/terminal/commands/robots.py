"""List, show and check robots."""

from pathlib import Path
from typing import Annotated, Any

import typer

from ...json_text import json_bytes
from ...kinds.registry import KINDS
from ..backend.protocol import Study
from ..backend.selection import open_backend
from ..options import (
    BaseLinkOption,
    GravityOption,
    JsonOption,
    KeyOption,
    MappingOption,
    ProfileOption,
    RobotArgument,
    TipLinkOption,
    UrlOption,
    mapping_of,
    part_of,
)
from ..output.audit import save_corrected
from ..output.exit_codes import Exit
from ..output.streams import echo, result_console, write
from ..study import Destination, run

COMMANDS = typer.Typer(
    help="List, show and check robots.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    epilog="\b\nExample:\n  veritorque robots list",
)
GEOMETRY = ("alpha", "d", "theta_offset", "r", "gamma", "b")


@COMMANDS.command(name="list", epilog="\b\nExample:\n  veritorque robots list")
def list_robots(*, url: UrlOption = "", key: KeyOption = "", json: JsonOption = False) -> None:
    """List the built-in and, with --url, the stored robots."""
    with open_backend(url, key) as backend:
        robots = backend.robots()
    if json:
        write(json_bytes(robots))
        return
    for robot in robots:
        echo(f"{robot['id']:<16}  {robot['joints']:>2} joints  {robot['name']}")


@COMMANDS.command(
    epilog="\b\nExamples:\n  veritorque robots show yumi-left\n"
    "  veritorque robots show robot.urdf --tip-link joint_7 --json"
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
    """Show a robot; with --json its description, also for a URDF."""
    with open_backend(url, key) as backend:
        seen = backend.robot(robot, part_of(base_link, tip_link, gravity))
    if json:
        write(json_bytes(seen["description"]))
        return
    echo(f"{seen['name']}: {seen['joints']} joints, gravity {_listed(seen['description']['gravity'])} m/s2")
    _print_joints(seen["description"]["joints"])
    _print_warnings(seen)


@COMMANDS.command(
    epilog="\b\nExamples:\n  veritorque robots check examples/yumi/robot.json\n"
    "  veritorque robots check robot.urdf --tip-link joint_7 --gravity=0,0,-9.81"
)
def check(  # noqa: PLR0913  # the options of a command line
    robot: RobotArgument,
    *,
    base_link: BaseLinkOption = "",
    tip_link: TipLinkOption = "",
    gravity: GravityOption = "",
    fail_on_findings: Annotated[
        bool, typer.Option("--fail-on-findings", help="Exit with code 1 if there are warnings.")
    ] = False,
    url: UrlOption = "",
    key: KeyOption = "",
) -> None:
    """Check a description: invalid values are errors, implausible values are warnings."""
    with open_backend(url, key) as backend:
        seen = backend.robot(robot, part_of(base_link, tip_link, gravity))
    echo(f"{seen['name']}: {seen['joints']} joints; valid")
    _print_warnings(seen)
    if fail_on_findings and seen["suspicions"]:
        raise typer.Exit(Exit.FOUND)


@COMMANDS.command(
    epilog="\b\nExamples:\n  veritorque robots base-parameters yumi-left\n"
    "  veritorque robots base-parameters robot.urdf --tip-link joint_3"
)
def base_parameters(  # noqa: PLR0913  # the options of a command line
    robot: RobotArgument,
    *,
    base_link: BaseLinkOption = "",
    tip_link: TipLinkOption = "",
    gravity: GravityOption = "",
    url: UrlOption = "",
    key: KeyOption = "",
    json: JsonOption = False,
) -> None:
    """List the base parameters of a robot with their groupings."""
    with open_backend(url, key) as backend:
        document = backend.base_parameters(robot, part_of(base_link, tip_link, gravity))
    if json:
        write(json_bytes(document))
        return
    counts = document["counts"]
    echo(f"{counts['standard']} standard parameters, {counts['base']} base parameters")
    for row in document["base_parameters"]:
        echo(f"{row['name']:<8}{row['unit']:<12}{row['grouping']}")
    rank = document["rank"]
    echo(
        f"a column counts as dependent below {rank['relative_tolerance']:.0e} of itself; "
        f"the weakest one that was kept has {rank['least_share_kept']:.2g}"
    )
    if document["without_effect"]:
        echo(f"without effect on the torque: {', '.join(document['without_effect'])}")


@COMMANDS.command(
    epilog="\b\nExamples:\n  veritorque robots audit robot.urdf --tip-link joint_7 --makers-mass 11\n"
    "  veritorque robots audit robot.urdf examples/yumi/log.csv --tip-link joint_7 --urdf corrected.urdf"
)
def audit(  # noqa: PLR0913  # the options of a command line
    robot: RobotArgument,
    logs: Annotated[
        list[Path] | None, typer.Argument(metavar="[LOG...]", help="Logs to audit against.")
    ] = None,
    *,
    makers_mass: Annotated[
        float | None, typer.Option(help="Mass of the robot by its data sheet, kg.")
    ] = None,
    corrected: Annotated[
        Path | None, typer.Option("--urdf", help="Save the corrected description as a URDF here.")
    ] = None,
    fail_on_findings: Annotated[
        bool, typer.Option("--fail-on-findings", help="Exit with code 1 if anything is found.")
    ] = False,
    base_link: BaseLinkOption = "",
    tip_link: TipLinkOption = "",
    gravity: GravityOption = "",
    mapping: MappingOption = "",
    profile: ProfileOption = "",
    url: UrlOption = "",
    key: KeyOption = "",
    json: JsonOption = False,
) -> None:
    """Audit described masses, mass centres and inertias, by themselves or against logs."""
    part = part_of(base_link, tip_link, gravity)
    options: dict[str, Any] = {} if makers_mass is None else {"makers_mass": makers_mass}
    if logs:
        study = Study("audit", robot, tuple(logs), mapping_of(mapping, profile), options, part)
        document = run(study, url=url, key=key, destination=Destination(json, None, None))
    else:
        with open_backend(url, key) as backend:
            document = backend.audit(robot, part, options)
        if json:
            write(json_bytes(document))
    if not json:
        KINDS["audit"].show(result_console(), document)
    if corrected is not None:
        save_corrected(document, robot, part, corrected)
    if fail_on_findings and (document["remarks"] or document["contradicted"]):
        raise typer.Exit(Exit.FOUND)


def _print_joints(rows: list[dict[str, Any]]) -> None:
    from ..output.columns import Column, print_table

    shown = [name for name in GEOMETRY if any(row.get(name) for row in rows)]
    columns = [
        Column("joint", list(map(str, range(1, len(rows) + 1)))),
        Column("name", _texts(rows, "name"), is_text=True, spare=3),
        Column("type", list(map(_type_of, rows)), is_text=True, spare=1),
        Column("on", _texts(rows, "antecedent"), spare=2),
        *(Column(name, [f"{row.get(name) or 0.0:.4g}" for row in rows]) for name in shown),
        Column("position", list(map(_limits_of, rows)), spare=4),
    ]
    print_table(result_console(), columns)


def _texts(rows: list[dict[str, Any]], name: str) -> list[str]:
    return [str(row.get(name, "")) for row in rows]


def _type_of(row: dict[str, Any]) -> str:
    return str(row.get("type", "")) + (f", mimics {row['mimics']}" if row.get("mimics") else "")


def _limits_of(row: dict[str, Any]) -> str:
    limit = (row.get("limits") or {}).get("position")
    return "" if limit is None else f"{limit[0]:.4g} .. {limit[1]:.4g}"


def _print_warnings(seen: dict[str, Any]) -> None:
    for suspicion in seen["suspicions"]:
        echo(f"warning: {suspicion}")


def _listed(values: list[float]) -> str:
    return ", ".join(f"{value:.4g}" for value in values)
