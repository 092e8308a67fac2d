"""Draw a diagnosis: a finding's residual without and with it, and all joints before and after."""

from collections.abc import Sequence

from .markup import Html, tag, together
from .svg import Frame, picture, span
from .words import MINUS, Document, coordinate, percent

_WIDE, _HIGH = 450.0, 320.0
_BARS_WIDE = 480.0
_SIDES = ((0.0, "both"), (-1.0, "backward"), (1.0, "forward"))
_IN_95 = 1.96
_ROW = 30.0


def finding_figure(curve: Document, unit: str) -> Html:
    """Show the mean residual over the coordinate that explains it: without the finding, then with it.

    The curve in the first picture is what the finding takes away, so that dots on it are explained.
    """
    taken = [before - after for before, after in zip(curve["before"], curve["after"], strict=True)]
    reach = [_IN_95 * error for error in curve["standard_error"]]
    high = [value + room for value, room in zip(taken, reach, strict=True)]
    low = [value - room for value, room in zip(taken, reach, strict=True)]
    x, y = span(curve["centre"], margin=0.03), span(curve["before"], curve["after"], high, low)
    frame = Frame(0.0, 0.0, _WIDE, _HIGH, x, y)
    without, within = list[Html](), list[Html]()
    for rows, kind in _sides(curve):
        at, room = _taken(curve["centre"], rows), _taken(reach, rows)
        without += [
            frame.band(at, _taken(low, rows), _taken(high, rows), "model"),
            frame.line(at, _taken(taken, rows), "model"),
            frame.dots(at, _taken(curve["before"], rows), kind),
        ]
        within += [
            frame.band(at, [-one for one in room], room, "floor"),
            frame.dots(at, _taken(curve["after"], rows), kind),
        ]
    panels = (
        _panel(frame, curve, "before: without it in the model", unit, without),
        _panel(frame, curve, "after: with it in the model", unit, within),
    )
    return tag("figure", tag("div", *panels, class_="pair"), tag("figcaption", _caption(curve)))


def dependence_figure(listed: Sequence[tuple[Document, str]]) -> Html | None:
    """Show what is left of some joints' residuals, each over one coordinate, and in which unit.

    Bars of 95 % are drawn as a band about zero.
    """
    if not listed:
        return None
    panels = (_dependence(one, unit) for one, unit in listed)
    note = "Dots: means of equally many samples. Shaded: where noise alone would leave 95 of 100 dots."
    return tag("figure", tag("div", *panels, class_="pair"), tag("figcaption", note))


def _dependence(dependence: Document, unit: str) -> Html:
    at, mean = dependence["centre"], dependence["mean"]
    room = [_IN_95 * error for error in dependence["standard_error"]]
    below = [-one for one in room]
    frame = Frame(0.0, 0.0, _WIDE, _HIGH, span(at, margin=0.03), span(mean, room, below))
    drawn = [frame.band(at, below, room, "floor"), frame.dots(at, mean, "both")]
    return _panel(frame, dependence, f"joint {dependence['joint']}: what is left", unit, drawn)


def _panel(frame: Frame, shown: Document, title: str, unit: str, drawn: Sequence[Html]) -> Html:
    """Put what is drawn of a joint's mean residual over a coordinate between axes."""
    joint = int(shown["joint"])
    name = coordinate(shown["coordinate"], joint)
    told = f"Measured minus predicted torque of joint {joint} over the {name}, {title}."
    labels = (f"{name}, {shown['unit']}", f"measured {MINUS} predicted, {unit}")
    parts = (frame.axes(title, *labels), frame.zero(), *drawn)
    return picture(f"{title}, over the {name}", told, (_WIDE, _HIGH), *parts)


def joint_bars(title: str, before: Sequence[float], after: Sequence[float], label: str) -> Html:
    """Compare one percentage per joint before and after as bars."""
    height = _ROW * len(before) + 4.0
    scale = (_BARS_WIDE - 160.0) / max([*before, *after, 1e-9])
    rows = [
        _bar_pair(place, 4.0 + _ROW * place, (old * scale, new * scale), (old, new))
        for place, (old, new) in enumerate(zip(before, after, strict=True))
    ]
    told = "; ".join(
        f"joint {place + 1}: {percent(old)} before, {percent(new)} after"
        for place, (old, new) in enumerate(zip(before, after, strict=True))
    )
    drawn = picture(title, told, (_BARS_WIDE, height), *rows)
    return tag("figure", tag("figcaption", label), drawn, class_="bars")


def _bar_pair(place: int, top: float, widths: tuple[float, float], values: tuple[float, float]) -> Html:
    parts: list[object] = [tag("text", f"joint {place + 1}", x=0, y=top + 16.0)]
    for shift, width, value, kind in zip((0.0, 12.0), widths, values, ("before", "after"), strict=True):
        bar = tag(
            "rect", x=60, y=top + shift, width=round(max(width, 0.5), 1), height=10, class_=f"bar {kind}"
        )
        parts += [bar, tag("text", f"{percent(value)} {kind}", x=round(66.0 + width, 1), y=top + shift + 9.0)]
    return together(parts)


def _sides(curve: Document) -> list[tuple[list[int], str]]:
    """List the bins of either direction of motion, or all where both count together."""
    directions = curve.get("direction") or [0.0] * len(curve["centre"])
    found = [([row for row, one in enumerate(directions) if one == side], kind) for side, kind in _SIDES]
    return [(rows, kind) for rows, kind in found if rows]


def _taken(values: Sequence[float], rows: list[int]) -> list[float]:
    return [values[row] for row in rows]


def _caption(curve: Document) -> str:
    apart = any(curve.get("direction") or [])
    dots = (
        "Dots: means of equally many samples, filled in forward motion, open in backward motion."
        if apart
        else "Dots: means of equally many samples."
    )
    return (
        f"{dots} Curve: what the finding adds that no other parameter can take up; dots that lie on it are "
        "explained. Shaded: where noise alone would leave 95 of 100 dots."
    )
