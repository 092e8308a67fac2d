"""Diagnose the causes of a robot's simulation error."""

from typing import Annotated

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
from ..output.exit_codes import Exit
from ..study import OutOption, ReportOption, Wanted, run

COMMANDS = typer.Typer(add_completion=False, rich_markup_mode=None)
EPILOG = """\b
Examples:
  veritorque diagnose yumi-left examples/yumi/hidden_log.csv --report diagnosis.html --fail-on-findings
  veritorque diagnose robot.urdf examples/yumi/hidden_log.csv --tip-link joint_7 --gravity=0,0,-9.81
"""
ReferenceOption = Annotated[
    str,
    typer.Option(help="Reference: an earlier result (a file; with --url a job), or prior."),
]
FailOption = Annotated[bool, typer.Option("--fail-on-findings", help="Exit with 1 if there are findings.")]


@COMMANDS.command(epilog=EPILOG)
def diagnose(  # noqa: PLR0913  # the options of a command line
    robot: RobotArgument,
    logs: LogsArgument,
    *,
    reference: ReferenceOption = "",
    fail_on_findings: FailOption = False,
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
    """Identify a robot, then find the causes of its simulation error and what correcting them improves."""
    chosen = options_of(options, settings) | ({"reference": reference} if reference else {})
    part = part_of(base_link, tip_link, gravity)
    study = Study("diagnose", robot, tuple(logs), mapping_of(mapping, profile), chosen, part)
    document = run(study, url=url, key=key, wanted=Wanted(json, out, report))
    if not json:
        from ..output.findings import print_diagnosis
        from ..output.streams import out as console

        print_diagnosis(console(), document)
    if fail_on_findings and document["diagnosis"]["verdict"] != "nothing_found":
        raise typer.Exit(Exit.FOUND)
