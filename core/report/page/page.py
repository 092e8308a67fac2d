"""Compose the report of a job as one HTML file from its result document.

The page holds no script and loads nothing from elsewhere.
"""

from collections.abc import Sequence

from ...document.model.answer import EXTENDED, model_name
from . import overview, remainder, robot
from .conflicts import disagreements, other_warnings
from .figures import dependence_figure
from .findings import findings
from .joints import joint_errors
from .render import render
from .running import Origin, facts, print_margins
from .source import sources
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
        The job of the document, if there is one.
    traces
        Measured and estimated signals over time, decimated, if they were stored.
    """
    document = {"diagnosis": None, "doubts": [], "defects": []} | dict(document)
    names = [str(log.get("name", "")) for log in document.get("logs") or []]
    shown = _diagnosis(document) if document["diagnosis"] else _identification(document)
    common = {
        "document": document,
        "policy": POLICY,
        "title": f"{document['robot']['name']}: {'diagnosis' if document['diagnosis'] else 'identification'}",
        "version": (document.get("provenance") or {}).get("version", ""),
        "facts": facts(document, origin),
        "disagreements": disagreements(document),
        "warnings": other_warnings(document),
        "print_margins": print_margins(document, origin),
        "traces": traces_section(traces, names),
    }
    return str(render("page.html.j2", common | sources(document) | shown))


def _diagnosis(document: Document) -> dict[str, object]:
    extended = model_name(document) == EXTENDED
    return {
        "headline": overview.headline(document),
        "overview_lines": overview.overview_lines(document),
        "improvement": overview.improvement(document),
        "findings": findings(document),
        **joint_errors(document),
        "remainder": remainder.sentences(document),
        "residuals": remainder.residuals(document),
        "dependences": dependence_figure(remainder.clearest_dependences(document)),
        "not_identifiable": remainder.not_identifiable(document),
        "parameters_heading": f"Parameters of the {'extended ' if extended else ''}model",
        "base_parameters": robot.base_parameters(document["base_parameters"]),
    }


def _identification(document: Document) -> dict[str, object]:
    return {
        "headline": robot.headline(document),
        "overview_lines": [],
        "improvement": "",
        "scores": robot.scores(document),
        "consistency": robot.consistency(document),
        "base_parameters": robot.base_parameters(document["base_parameters"]),
    }
