"""Render the templates of the page; Jinja2 and MarkupSafe escape every text that is not markup of ours."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup, escape

from .words import joints

TEMPLATES = Environment(
    loader=FileSystemLoader(Path(__file__).parent / "templates"),
    autoescape=True,
    undefined=StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
)
TEMPLATES.filters["joints"] = joints


class Table(NamedTuple):
    """Hold a table: the first cell of a row heads it, text columns are aligned to the left."""

    caption: str
    headings: Sequence[str]
    rows: Sequence[Sequence[object]]
    note: str = ""
    text_columns: Sequence[int] = ()


def render(template: str, values: dict[str, object]) -> Markup:
    """Render a template; an undefined value is an error."""
    return Markup(TEMPLATES.get_template(template).render(values))  # noqa: S704  # output of autoescape


def element(name: str, *children: object, **attributes: object) -> Markup:
    """Write an element; a trailing underscore of an attribute is dropped, others become hyphens.

    Examples
    --------
    >>> element("p", "a < b", class_="note")
    Markup('<p class="note">a &lt; b</p>')
    """
    written = (
        Markup(' {}="{}"').format(key.rstrip("_").replace("_", "-"), value)
        for key, value in attributes.items()
    )
    return Markup("<{0}{1}>{2}</{0}>").format(
        name, Markup("").join(written), Markup("").join(map(escape, children))
    )
