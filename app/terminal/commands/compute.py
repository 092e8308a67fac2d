"""Make the command of a kind of job: its arguments follow from what the kind takes and offers."""

from inspect import Parameter, Signature
from pathlib import Path
from typing import Annotated, Any

import typer

from ...kinds.kind import JobKind
from ...kinds.registry import KINDS
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
from ..output.streams import result_console
from ..study import Destination, run

OutOption = Annotated[Path | None, typer.Option("--out", "-o", help="Save the result document here.")]
ReportOption = Annotated[Path | None, typer.Option(help="Save the report, one HTML file, here.")]


def command_of(name: str) -> typer.Typer:
    """Make the command of the kind of this name."""
    kind = KINDS[name]
    commands = typer.Typer(add_completion=False, rich_markup_mode=None)
    examples = "\n".join(f"  veritorque {command}" for command in kind.words.commands)
    register = commands.command(help=kind.words.help, epilog=f"\b\nExamples:\n{examples}\n")

    def compute(**given: Any) -> None:  # noqa: ANN401  # what `_parameters` declares
        _run(kind, given)

    parameters = _parameters(kind)
    compute.__signature__ = Signature(parameters)  # type: ignore[attr-defined]  # typer reads it
    compute.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    register(compute)
    return commands


def _run(kind: JobKind[Any], given: dict[str, Any]) -> None:
    options = options_of(given["options"], given["settings"])
    options |= {name: given[name] for name in kind.words.flags if given[name]}
    study = Study(
        kind.name,
        given["robot"],
        tuple(given.get("logs", ())),
        mapping_of(given.get("mapping", ""), given.get("profile", "")),
        options,
        part_of(given["base_link"], given["tip_link"], given["gravity"]),
    )
    destination = Destination(given["json"], given["out"], given.get("report"))
    document = run(study, url=given["url"], key=given["key"], destination=destination)
    if not given["json"]:
        kind.show(result_console(), document)
    alarm = kind.words.alarm
    if alarm is not None and given[alarm.name] and alarm.is_raised(document):
        raise typer.Exit(Exit.FOUND)


def _parameters(kind: JobKind[Any]) -> list[Parameter]:
    """Declare the arguments and options of a kind's command, in the order in which the help shows them."""
    words = kind.words
    arguments = [("robot", RobotArgument), *([("logs", LogsArgument)] if kind.takes_logs else ())]
    options: list[tuple[str, Any, object]] = [
        *((name, Annotated[str, typer.Option(help=text)], "") for name, text in words.flags.items()),
        *([_flag(words.alarm.name, words.alarm.help)] if words.alarm else ()),
        ("base_link", BaseLinkOption, ""),
        ("tip_link", TipLinkOption, ""),
        ("gravity", GravityOption, ""),
        *((("mapping", MappingOption, ""), ("profile", ProfileOption, "")) if kind.takes_logs else ()),
        ("options", OptionsOption, ""),
        ("settings", SetOption, []),
        ("url", UrlOption, ""),
        ("key", KeyOption, ""),
        ("json", JsonOption, False),
        ("out", OutOption, None),
        *([("report", ReportOption, None)] if kind.has_report else ()),
    ]
    return [
        *(Parameter(name, Parameter.POSITIONAL_OR_KEYWORD, annotation=type_) for name, type_ in arguments),
        *(
            Parameter(name, Parameter.KEYWORD_ONLY, default=default, annotation=type_)
            for name, type_, default in options
        ),
    ]


def _flag(name: str, text: str) -> tuple[str, Any, object]:
    return name, Annotated[bool, typer.Option(f"--{name.replace('_', '-')}", help=text)], False
