"""Identify a robot from its logs."""

import typer

from ..backend.protocol import Study
from ..options import (
    BaseLinkOption,
    GravityOption,
    JsonOption,
    KeyOption,
    LogsArgument,
    MappingOption,
    OptionsOption,
    ProfileOption,
    RobotArgument,
    SetOption,
    TipLinkOption,
    UrlOption,
    mapping_of,
    options_of,
    part_of,
)
from ..study import OutOption, ReportOption, Wanted, run

COMMANDS = typer.Typer(add_completion=False, rich_markup_mode=None)
EPILOG = """\b
Examples:
  veritorque identify yumi-left examples/yumi/log.csv
  veritorque identify examples/yumi/robot.json examples/yumi/log.csv --set bootstrap.draws=0 --json
  veritorque identify robot.urdf examples/yumi/log.csv --tip-link joint_7 --set bootstrap.draws=0
"""


@COMMANDS.command(epilog=EPILOG)
def identify(  # noqa: PLR0913  # the options of a command line
    robot: RobotArgument,
    logs: LogsArgument,
    *,
    base_link: BaseLinkOption = "",
    tip_link: TipLinkOption = "",
    gravity: GravityOption = "",
    mapping: MappingOption = "",
    profile: ProfileOption = "",
    options: OptionsOption = "",
    settings: SetOption = [],  # noqa: B006  # typer reads it and makes a new one
    url: UrlOption = "",
    key: KeyOption = "",
    json: JsonOption = False,
    out: OutOption = None,
    report: ReportOption = None,
) -> None:
    """Identify physically consistent parameters of a robot from its logs, with standard deviations."""
    study = Study(
        "identify",
        robot,
        tuple(logs),
        mapping_of(mapping, profile),
        options_of(options, settings),
        part_of(base_link, tip_link, gravity),
    )
    document = run(study, url=url, key=key, wanted=Wanted(json, out, report))
    if not json:
        from ..output.streams import out as console
        from ..output.tables import print_result

        print_result(console(), document)
