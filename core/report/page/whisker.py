"""Draw a parameter with its error bars in a row of a table.

Every row has its own scale: rows are comparable in distance from zero relative to the uncertainty.
"""

from markupsafe import Markup

from .render import element
from .words import Document, number, unit

_WIDE, _HIGH, _MARGIN = 120.0, 16.0, 4.0
_MIDDLE = _HIGH / 2.0


def whisker(row: Document) -> Markup | None:
    """Draw value, 95 % interval (thick), bootstrap interval (thin) and zero; None without an interval."""
    ends = _ends(row, "interval_95")
    if row.get("value") is None or ends is None:
        return None
    value, drawn = float(row["value"]), _ends(row, "bootstrap_interval_95") or ends
    every = (0.0, value, *ends, *drawn)
    low, high = min(every), max(every)
    if not high > low:
        return None

    def at(end: float) -> float:
        return round(_MARGIN + (_WIDE - 2.0 * _MARGIN) * (end - low) / (high - low), 1)

    label = f"{row['name']}: 95 % interval {number(ends[0])} to {number(ends[1])} {unit(row['unit'])}"
    return element(
        "svg",
        element("title", label),
        element("desc", f"{label}; block bootstrap {number(drawn[0])} to {number(drawn[1])}."),
        element("line", x1=at(0.0), x2=at(0.0), y1=1, y2=_HIGH - 1, class_="grid zero"),
        _bar(at(drawn[0]), at(drawn[1]), "thin"),
        _bar(at(ends[0]), at(ends[1]), "thick"),
        element("circle", cx=at(value), cy=_MIDDLE, r=2.6, class_="dot both"),
        viewBox=f"0 0 {_WIDE:g} {_HIGH:g}",
        class_="whisker",
        role="img",
        xmlns="http://www.w3.org/2000/svg",
    )


def _ends(row: Document, name: str) -> tuple[float, float] | None:
    low, high = row.get(name) or (None, None)
    return None if low is None or high is None else (float(low), float(high))


def _bar(begin: float, end: float, kind: str) -> Markup:
    return element("line", x1=begin, x2=end, y1=_MIDDLE, y2=_MIDDLE, class_=f"bar {kind}")
