"""Write HTML and SVG elements so that no text can become markup by accident.

Every child that is not an `Html` is escaped, because names of robots, logs and joints come from users.
"""

from collections.abc import Iterable, Sequence
from html import escape

Cell = str | float | None
_ON_ONE_SHEET = 24
"""Rows up to which a printed table is kept on one sheet of paper."""


class Html(str):
    """Mark text that is markup already."""

    __slots__ = ()


def tag(name: str, *children: object, **attributes: object) -> Html:
    """Write an element; an attribute's trailing underscore is dropped, others become hyphens.

    Attributes that are None are left out.

    Examples
    --------
    >>> tag("p", "a < b", class_="note")
    '<p class="note">a &lt; b</p>'
    >>> tag("p", tag("b", "bold"), " text")
    '<p><b>bold</b> text</p>'
    """
    written = "".join(
        f' {key.rstrip("_").replace("_", "-")}="{escape(str(value))}"'
        for key, value in attributes.items()
        if value is not None
    )
    return Html(f"<{name}{written}>{together(children)}</{name}>")


def together(parts: Iterable[object]) -> Html:
    """Join parts, escaping those that are no markup; None and empty parts vanish.

    Examples
    --------
    >>> together(["<", tag("i", "x"), None])
    '&lt;<i>x</i>'
    """
    return Html(
        "".join(part if isinstance(part, Html) else escape(str(part)) for part in parts if part is not None)
    )


def listing(items: Iterable[object]) -> Html | None:
    """Write a list; None where there is nothing to list."""
    written = [tag("li", item) for item in items]
    return tag("ul", *written) if written else None


def table(
    caption: str,
    headings: Sequence[object],
    rows: Iterable[Sequence[object]],
    *,
    note: object = None,
    text: Sequence[int] = (),
) -> Html:
    """Write a table whose first column heads its rows; numbers are expected as text already.

    Parameters
    ----------
    text
        Columns that hold words and begin at the left.
    """
    sides = ["text" if place in text else None for place in range(len(headings))]
    head = tag(
        "tr", *(tag("th", one, scope="col", class_=side) for one, side in zip(headings, sides, strict=True))
    )
    body = [
        tag(
            "tr",
            tag("th", row[0], scope="row"),
            *(tag("td", cell, class_=side) for cell, side in zip(row[1:], sides[1:], strict=True)),
        )
        for row in rows
    ]
    inside = (tag("caption", caption), tag("thead", head), tag("tbody", *body))
    below = tag("p", note, class_="note") if note else None
    kind = "wide" if len(body) <= _ON_ONE_SHEET else "wide long"
    return together([tag("div", tag("table", *inside), class_=kind, tabindex=0), below])


def section(heading: str, *parts: object, key: str | None = None) -> Html:
    """Write a section with a heading; `key` is the name by which a link finds it."""
    return tag("section", tag("h2", heading), *parts, id=key)
