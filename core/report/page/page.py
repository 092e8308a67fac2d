"""Compose the report of a job as one HTML file that opens anywhere, from its result document alone.

It holds no script and asks for nothing from elsewhere. The first screen says what came out; everything below
is what that sentence rests on.
"""

from core.report.page import overview, robot
from core.report.page.findings import findings_section
from core.report.page.joints import joints_section
from core.report.page.markup import Html, tag, together
from core.report.page.remainder import not_shown_section, unexplained_section
from core.report.page.source import data_section, method_section
from core.report.page.style import STYLE
from core.report.page.words import Document

POLICY = "default-src 'none'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'"


def compose_page(document: Document) -> str:
    """Write the report of a result document of either kind."""
    diagnosed = bool(document.get("diagnosis"))
    name = document["robot"]["name"]
    what = "diagnosis" if diagnosed else "identification"
    body = _diagnosis(document) if diagnosed else _identification(document)
    head = tag(
        "head",
        Html(f'<meta charset="utf-8"><meta http-equiv="Content-Security-Policy" content="{POLICY}">'),
        Html('<meta name="viewport" content="width=device-width, initial-scale=1">'),
        tag("title", f"{name}: {what}"),
        tag("style", Html(STYLE)),
    )
    header = tag("h1", f"{name}: {what} from {_logs(document)}")
    whole = tag(
        "html", head, tag("body", tag("main", tag("header", header, *body[:2]), *body[2:])), lang="en"
    )
    return f"<!doctype html>\n{whole}\n"


def _diagnosis(document: Document) -> list[object]:
    gained = overview.gained(document)
    after = document["diagnosis"]["after"].get("base_parameters") or []
    return [
        tag("p", overview.headline(document), class_="verdict"),
        together([overview.at_a_glance(document), tag("p", gained) if gained else None]),
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
        tag("p", robot.headline(document), class_="verdict"),
        None,
        robot.doubts_section(document),
        robot.scores_section(document),
        robot.existence_section(document),
        robot.parameters_section(document["base_parameters"], "The parameters"),
        data_section(document),
        method_section(document),
    ]


def _logs(document: Document) -> Html:
    names = [str(log.get("name", "")) for log in document.get("logs") or []]
    return together([", ".join(names) or "its log"])
