"""Say on the first screen and on every printed sheet which job this is, of which robot, from when.

What the browser prints in a sheet's margins comes from the style sheet, so text goes there as escaped
characters only: a robot's name can be anything. Source: CSS Paged Media, margin boxes.
"""

from dataclasses import dataclass

from .markup import Html, tag
from .words import Document


@dataclass(frozen=True)
class Origin:
    """Name the job that a result is of, and when it ended (ISO 8601)."""

    job: str
    finished: str

    @property
    def date(self) -> str:
        """Give the day and the minute, UTC."""
        return f"{self.finished[:16].replace('T', ' ')} UTC" if self.finished else ""


def facts(document: Document, origin: Origin | None) -> Html:
    """List what a colleague asks first: of which robot and log it is, from when, and made by what."""
    given = document.get("provenance") or {}
    logs = ", ".join(str(log.get("name", "")) for log in document.get("logs") or [])
    listed = {
        "Robot": document["robot"]["name"],
        "Logs": logs,
        "Job": origin.job if origin else "",
        "Finished": origin.date if origin else "",
        "Made by": f"Veritorque {given.get('version', '')}",
    }
    rows = [tag("div", tag("dt", name), tag("dd", told)) for name, told in listed.items() if told]
    return tag("dl", *rows, class_="facts")


def sheets(document: Document, origin: Origin | None) -> str:
    """Write the part of the style sheet that heads and numbers printed sheets."""
    kind = "diagnosis" if document.get("diagnosis") else "identification"
    left = f"{document['robot']['name']}: {kind}"
    below = " · ".join(part for part in (origin.job, origin.date) if part) if origin else "Veritorque"
    return (
        f"@page {{ @top-left {{ content: {css_string(left)}; }} @top-right {{ content: 'Veritorque'; }}"
        f" @bottom-left {{ content: {css_string(below)}; }}"
        " @bottom-right { content: counter(page) ' / ' counter(pages); } }"
    )


def css_string(text: str) -> str:
    r"""Write any text as a string of CSS in which nothing can end the string or the sheet.

    Examples
    --------
    >>> css_string("arm 2</style>")
    "'arm\\20 2\\3c \\2f style\\3e '"
    """
    safe = "".join(one if one.isascii() and one.isalnum() else f"\\{ord(one):x} " for one in text[:120])
    return f"'{safe}'"
