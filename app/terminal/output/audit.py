"""Print an audit: impossible bodies, entries that logs contradict, and combinations that disagree."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.markup import escape

from ....core.errors import OptionError
from ..backend.protocol import FromUrdf
from .columns import Column, print_table
from .files import means_a_file, save
from .streams import note
from .tables import number
from .warnings import print_warnings

Document = Mapping[str, Any]


def print_audit(console: Console, document: Document) -> None:
    """Print warnings, remarks, contradictions and the combinations that disagree."""
    print_warnings(console, document)
    total = document["total_mass"]["described"]
    if total is not None:
        console.print(f"Moving links: {number(total)} kg together")
    for remark in document["remarks"]:
        console.print(f"[red]{escape(remark['statement'])}[/]. Remedy: {escape(remark['remedy'])}.")
    if document["bodies_described"] and not document["remarks"]:
        console.print("[green]The description by itself has no impossible body.[/]")
    for line in contradiction_lines(document):
        console.print(escape(line))
    _print_contradicted(console, document)


def _print_contradicted(console: Console, document: Document) -> None:
    wrong = [row for row in document["combinations"] if row["contradicted"]]
    if wrong:
        print_table(console, _columns(wrong), title="Combinations that the logs contradict")


def contradiction_lines(document: Document) -> list[str]:
    """Say which entries the logs contradict, or why none can be judged.

    Examples
    --------
    >>> contradiction_lines({"judged": False, "not_judged_because": "no log was given", "logs": []})
    ['Not compared with motion: no log was given.']
    """
    if not document["judged"]:
        return [f"Not compared with motion: {document['not_judged_because']}."]
    if not document["contradicted"]:
        return ["The logs contradict no entry of the description."]
    lines = []
    for row in document["contradicted"]:
        others = [f"{other['entry']} of link {other['link']}" for other in row["ambiguous_with"]]
        also = f" Not distinguishable from: {', '.join(others)}." if others else ""
        lines.append(f"Contradicted: {row['statement']} (p = {row['p_value']:.1g}).{also}")
    return lines


def _columns(rows: list[Document]) -> list[Column]:
    return [
        Column("name", [row["name"] for row in rows], is_text=True),
        Column("described", [number(row["described"]) for row in rows]),
        Column("measured", [number(row["measured"]) for row in rows]),
        Column("deviation", [number(row["standard_deviation"]) for row in rows]),
        Column("unit", [row["unit"] for row in rows], is_text=True),
    ]


def save_corrected(document: Document, robot: str, part: FromUrdf, path: Path) -> None:
    """Save the corrected description, if there is one: in the URDF that was given, or as a new one.

    Raises
    ------
    OptionError
        If no log could judge the description, or a corrected body is impossible.
    """
    from ....core.export.described import urdf_of_description, urdf_with_bodies

    corrected = document["corrected_robot"]
    if corrected is None and document["judged"]:
        note(f"nothing is contradicted, so the description stays and {path} is not written")
        return
    if corrected is None:
        raise OptionError(
            "there is no corrected description to save",
            evidence={"judged": False},
            remedy="leave out --urdf, or give a log that excites the arm",
        )
    text = Path(robot).read_bytes() if means_a_file(robot) else b""
    if text.lstrip().startswith(b"<"):
        content = urdf_with_bodies(text, corrected, base_link=part.base_link, tip_link=part.tip_link)
    else:
        content = urdf_of_description(corrected)
    save(path, content)
    note(f"the corrected description is in {path}")
