"""Declare the arguments and options that several commands share, and read what was given for them."""

import json
from pathlib import Path
from typing import Annotated, Any

import typer

from ...core.errors import LogError, OptionError, RobotError, VeritorqueError
from .backend.protocol import FromUrdf

Document = dict[str, Any]

RobotArgument = Annotated[
    str,
    typer.Argument(
        metavar="ROBOT", help="Built-in robot, description (JSON) or URDF; with --url also an id."
    ),
]
BaseLinkOption = Annotated[str, typer.Option(help="URDF: the fixed base link.")]
TipLinkOption = Annotated[str, typer.Option(help="URDF: the last link of the robot; several as A,B.")]
GravityOption = Annotated[
    str, typer.Option(metavar="X,Y,Z", help="URDF: gravity in the base link's frame, m/s2.")
]
LogsArgument = Annotated[list[Path], typer.Argument(metavar="LOG...", help="Logs in any format.")]
MappingOption = Annotated[
    str, typer.Option(metavar="JSON|FILE", help="Columns and units of the channels; see docs/logs.md.")
]
ProfileOption = Annotated[str, typer.Option(help="The recorder that wrote the log, such as ur-rtde.")]
OptionsOption = Annotated[
    str,
    typer.Option("--options", metavar="JSON|FILE", help="Options of the computation; see docs/options.md."),
]
SetOption = Annotated[
    list[str], typer.Option("--set", metavar="NAME=VALUE", help="One option, such as filter.cutoff_hz=10.")
]
UrlOption = Annotated[
    str, typer.Option(envvar="VERITORQUE_URL", help="Address of the service that computes.")
]
KeyOption = Annotated[
    str, typer.Option(envvar="VERITORQUE_KEY", help="Key of the service; safer in the environment variable.")
]
JsonOption = Annotated[bool, typer.Option("--json", help="Print a JSON document only.")]


def part_of(base_link: str, tip_link: str, gravity: str) -> FromUrdf:
    """Join what was given of a URDF; what is empty was not given.

    Raises
    ------
    RobotError
        If gravity is not three numbers.

    Examples
    --------
    >>> part_of("", "left_hand", "0,0,-9.81")
    FromUrdf(base_link=None, tip_link='left_hand', gravity=(0.0, 0.0, -9.81))
    """
    return FromUrdf(base_link or None, tip_link or None, _vector(gravity) if gravity else None)


def mapping_of(mapping: str, profile: str) -> Document | None:
    """Join what was given of a mapping; None where nothing was.

    Raises
    ------
    LogError
        If it is no JSON object.
    """
    read = json_object(mapping, "the mapping", LogError) if mapping else {}
    if profile:
        read["profile"] = profile
    return read or None


def options_of(options: str, settings: list[str]) -> Document:
    """Join options from a document with single ones, which win.

    Raises
    ------
    OptionError
        If one is not written as name=value, or the document is no JSON object.

    Examples
    --------
    >>> options_of("", ["filter.cutoff_hz=10", "estimator=ols"])
    {'filter': {'cutoff_hz': 10}, 'estimator': 'ols'}
    """
    read = json_object(options, "the options", OptionError) if options else {}
    for setting in settings:
        name, sign, value = setting.partition("=")
        if not name or not sign:
            raise OptionError(
                f"{setting!r} is not an option",
                evidence={"given": setting},
                remedy="write --set name=value, such as --set filter.cutoff_hz=10",
            )
        _set_option(read, name.split("."), _value(value))
    return read


def json_object(given: str, what: str, error: type[VeritorqueError]) -> Document:
    """Read a JSON object from the command line, or from the file that it names.

    Raises
    ------
    VeritorqueError
        Of the given kind, if it is none.
    """
    text = given
    try:
        if not given.lstrip().startswith(("{", "[")):
            text = Path(given).read_text(encoding="utf-8")
        document = json.loads(text)
    except (OSError, ValueError) as reason:
        raise error(
            f"{what} cannot be read",
            evidence={"given": given[:200], "reason": str(reason)},
            remedy="give a JSON object, or the name of a file that holds one",
        ) from reason
    if not isinstance(document, dict):
        raise error(
            f"{what} must be a JSON object",
            evidence={"found": type(document).__name__},
            remedy='give named fields: {"...": ...}',
        )
    return document


def _vector(text: str) -> tuple[float, ...]:
    try:
        parts = tuple(float(part) for part in text.split(","))
    except ValueError:
        parts = ()
    if len(parts) != 3:
        raise RobotError(
            "gravity is not three numbers", evidence={"given": text}, remedy="write --gravity=0,0,-9.81"
        )
    return parts


def _value(text: str) -> object:
    """Read a value as JSON; what is none is a word."""
    try:
        return json.loads(text)
    except ValueError:
        return text


def _set_option(options: Document, path: list[str], value: object) -> None:
    for step in path[:-1]:
        inner = options.setdefault(step, {})
        if not isinstance(inner, dict):
            raise OptionError(
                f"{step} has a value and cannot have parts",
                evidence={"given": ".".join(path)},
                remedy="give the value or its parts, not both",
            )
        options = inner
    options[path[-1]] = value
