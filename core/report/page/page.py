"""Compose the report of a job as one HTML file that opens anywhere, from its result document alone.

It holds no script and asks for nothing from elsewhere. The first screen says what came out; everything below
is what that sentence rests on.
"""

from collections.abc import Sequence

from . import overview, robot
from .findings import findings_section
from .joints import joints_section
from .markup import Html, tag, together
from .remainder import not_shown_section, unexplained_section
from .running import Origin, facts, sheets
from .source import data_section, method_section
from .style import STYLE
from .traces import JointTraces, traces_section
from .words import Document

POLICY = "default-src 'none'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'"


def compose_page(
    document: Document, *, origin: Origin | None = None, traces: Sequence[JointTraces] = ()
) -> str:
    """Write the report of a result document of either kind.

    Parameters
    ----------
    origin
        The job that the document is the result of, where there is one.
    traces
        What was measured and estimated over time, thinned, where it was kept.
    """
    diagnosed = bool(document.get("diagnosis"))
    name = document["robot"]["name"]
    what = "diagnosis" if diagnosed else "identification"
    opening, *sections = _diagnosis(document) if diagnosed else _identification(document)
    drawn = traces_section(traces, [str(log.get("name", "")) for log in document.get("logs") or []])
    head = tag(
        "head",
        Html(f'<meta charset="utf-8"><meta http-equiv="Content-Security-Policy" content="{POLICY}">'),
        Html('<meta name="viewport" content="width=device-width, initial-scale=1">'),
        tag("title", f"{name}: {what}"),
        tag("style", Html(STYLE + sheets(document, origin))),
    )
    header = tag("header", tag("p", f"{name}: {what}", class_="kind"), opening, facts(document, origin))
    whole = [one for one in (*sections[:2], drawn, *sections[2:]) if one]
    body = tag("body", tag("main", header, *whole), _end(document))
    return f"<!doctype html>\n{tag('html', head, body, lang='en')}\n"


def _end(document: Document) -> Html:
    version = (document.get("provenance") or {}).get("version", "")
    return tag("footer", f"Veritorque {version}. Units are SI, angles in rad, joints counted from 1.")


def _diagnosis(document: Document) -> list[object]:
    gained = overview.gained(document)
    after = document["diagnosis"]["after"].get("base_parameters") or []
    told = [overview.at_a_glance(document), tag("p", gained) if gained else None]
    return [
        together([tag("h1", overview.headline(document), class_="verdict"), *told]),
        findings_section(document),
        joints_section(document),
        unexplained_section(document),
        not_shown_section(document),
        robot.doubts_section(document),
        data_section(document),
        method_section(document),
        robot.parameters_section(
            after or document["base_parameters"],
            "The extended model's parameters" if after else "The model's parameters",
        ),
    ]


def _identification(document: Document) -> list[object]:
    return [
        tag("h1", robot.headline(document), class_="verdict"),
        robot.doubts_section(document),
        robot.scores_section(document),
        robot.existence_section(document),
        robot.parameters_section(document["base_parameters"], "The parameters"),
        data_section(document),
        method_section(document),
    ]
