"""Draw the figures of a diagnosis: residuals before and after a finding, and errors of all joints."""

from collections.abc import Sequence

from markupsafe import Markup

from .render import element
from .svg import Frame, picture, span
from .words import MINUS, Document, coordinate, percent

_WIDE, _HIGH = 450.0, 320.0
_BARS_WIDE = 480.0
_SIDES = ((0.0, "both"), (-1.0, "backward"), (1.0, "forward"))
_IN_95 = 1.96
_DOTS = "means of bins with equal counts"
_SHADED = "95 % range of the means under noise alone"
_ROW = 30.0


def finding_figure(curve: Document, unit: str) -> Markup:
    """Draw the mean residual over the coordinate of the finding, before and after.

    The curve in the first picture is the contribution of the finding: dots on it are explained.
    """
    contribution = [before - after for before, after in zip(curve["before"], curve["after"], strict=True)]
    half_width = [_IN_95 * error for error in curve["standard_error"]]
    high = [value + width for value, width in zip(contribution, half_width, strict=True)]
    low = [value - width for value, width in zip(contribution, half_width, strict=True)]
    x, y = span(curve["centre"], margin=0.03), span(curve["before"], curve["after"], high, low)
    frame = Frame(0.0, 0.0, _WIDE, _HIGH, x, y)
    without, within = list[Markup](), list[Markup]()
    for rows, kind in _sides(curve):
        at, room = _rows_of(curve["centre"], rows), _rows_of(half_width, rows)
        without += [
            frame.band(at, _rows_of(low, rows), _rows_of(high, rows), "model"),
            frame.line(at, _rows_of(contribution, rows), "model"),
            frame.dots(at, _rows_of(curve["before"], rows), kind),
        ]
        within += [
            frame.band(at, [-width for width in room], room, "floor"),
            frame.dots(at, _rows_of(curve["after"], rows), kind),
        ]
    panels = (
        _panel(frame, curve, "before: model without the finding", unit, without),
        _panel(frame, curve, "after: model with the finding", unit, within),
    )
    return element("figure", element("div", *panels, class_="pair"), element("figcaption", _caption(curve)))


def dependence_figure(listed: Sequence[tuple[Document, str]]) -> Markup | None:
    """Draw residuals, each over one coordinate, with its unit; the 95 % band of the mean is around zero."""
    if not listed:
        return None
    panels = (_dependence(dependence, unit) for dependence, unit in listed)
    caption = f"Dots: {_DOTS}. Shaded: {_SHADED}."
    return element("figure", element("div", *panels, class_="pair"), element("figcaption", caption))


def _dependence(dependence: Document, unit: str) -> Markup:
    at, mean = dependence["centre"], dependence["mean"]
    room = [_IN_95 * error for error in dependence["standard_error"]]
    below = [-width for width in room]
    frame = Frame(0.0, 0.0, _WIDE, _HIGH, span(at, margin=0.03), span(mean, room, below))
    drawn = [frame.band(at, below, room, "floor"), frame.dots(at, mean, "both")]
    return _panel(frame, dependence, f"joint {dependence['joint']}: residual", unit, drawn)


def _panel(frame: Frame, shown: Document, title: str, unit: str, drawn: Sequence[Markup]) -> Markup:
    """Draw axes around a joint's mean residual over a coordinate."""
    joint = int(shown["joint"])
    name = coordinate(shown["coordinate"], joint)
    text = f"Measured minus predicted torque of joint {joint} over the {name}, {title}."
    labels = (f"{name}, {shown['unit']}", f"measured {MINUS} predicted, {unit}")
    parts = (frame.axes(title, *labels), frame.zero(), *drawn)
    return picture(f"{title}, over the {name}", text, (_WIDE, _HIGH), *parts)


def joint_bars(title: str, errors: Sequence[tuple[int, float, float]], label: str) -> Markup:
    """Draw one percentage per joint before and after as bars."""
    height = _ROW * len(errors) + 4.0
    scale = (_BARS_WIDE - 160.0) / max([*(max(own[1:]) for own in errors), 1e-9])
    rows = [_bar_pair(own, 4.0 + _ROW * index, scale) for index, own in enumerate(errors)]
    text = "; ".join(
        f"joint {joint}: {percent(old)} before, {percent(new)} after" for joint, old, new in errors
    )
    drawn = picture(title, text, (_BARS_WIDE, height), *rows)
    return element("figure", element("figcaption", label), drawn, class_="bars")


def _bar_pair(error: tuple[int, float, float], top: float, scale: float) -> Markup:
    joint, *values = error
    parts = [element("text", f"joint {joint}", x=0, y=top + 16.0)]
    for shift, value, kind in zip((0.0, 12.0), values, ("before", "after"), strict=True):
        width = value * scale
        bar = element(
            "rect", x=60, y=top + shift, width=round(max(width, 0.5), 1), height=10, class_=f"bar {kind}"
        )
        parts += [
            bar,
            element("text", f"{percent(value)} {kind}", x=round(66.0 + width, 1), y=top + shift + 9.0),
        ]
    return Markup("").join(parts)


def _sides(curve: Document) -> list[tuple[list[int], str]]:
    """List the bins per direction of motion, or all if the directions are not separated."""
    directions = curve.get("direction") or [0.0] * len(curve["centre"])
    found = [
        ([row for row, direction in enumerate(directions) if direction == side], kind)
        for side, kind in _SIDES
    ]
    return [(rows, kind) for rows, kind in found if rows]


def _rows_of(values: Sequence[float], rows: list[int]) -> list[float]:
    return [values[row] for row in rows]


def _caption(curve: Document) -> str:
    filled = ", filled in forward and open in backward motion" if any(curve.get("direction") or []) else ""
    return (
        f"Dots: {_DOTS}{filled}. Curve: contribution of the finding that no other parameter represents; dots "
        f"on it are explained. Shaded: {_SHADED}."
    )
