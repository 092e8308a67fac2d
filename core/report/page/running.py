"""State robot, logs, job and date at the top of the page and in the margins of printed sheets.

Margins are printed from the style sheet, where text is escaped as a CSS string. Source: CSS Paged Media.
"""

from dataclasses import dataclass

from markupsafe import Markup

from .words import Document


@dataclass(frozen=True)
class Origin:
    """Name the job of a result, and when it finished (ISO 8601)."""

    job: str
    finished: str

    @property
    def date(self) -> str:
        """Give date and minute, UTC."""
        return f"{self.finished[:16].replace('T', ' ')} UTC" if self.finished else ""


def facts(document: Document, origin: Origin | None) -> dict[str, str]:
    """List robot, logs, job, date and version."""
    provenance = document.get("provenance") or {}
    logs = ", ".join(str(log.get("name", "")) for log in document.get("logs") or [])
    return {
        "Robot": document["robot"]["name"],
        "Logs": logs,
        "Job": origin.job if origin else "",
        "Finished": origin.date if origin else "",
        "Made by": f"Veritorque {provenance.get('version', '')}",
    }


def print_margins(document: Document, origin: Origin | None) -> Markup:
    """Write the CSS rule that heads and numbers printed sheets."""
    kind = "diagnosis" if document.get("diagnosis") else "identification"
    left = f"{document['robot']['name']}: {kind}"
    below = " · ".join(part for part in (origin.job, origin.date) if part) if origin else "Veritorque"
    return Markup(  # noqa: S704  # css_string leaves nothing that ends a string or the style sheet
        f"@page {{ @top-left {{ content: {css_string(left)}; }} @top-right {{ content: 'Veritorque'; }}"
        f" @bottom-left {{ content: {css_string(below)}; }}"
        " @bottom-right { content: counter(page) ' / ' counter(pages); } }"
    )


def css_string(text: str) -> str:
    r"""Write any text as a CSS string that cannot end the string or the style sheet.

    Examples
    --------
    >>> css_string("arm 2</style>")
    "'arm\\20 2\\3c \\2f style\\3e '"
    """
    safe = "".join(
        letter if letter.isascii() and letter.isalnum() else f"\\{ord(letter):x} " for letter in text[:120]
    )
    return f"'{safe}'"
