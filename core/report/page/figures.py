"""Draw a diagnosis: a finding's residual without and with it, and all joints before and after."""

from collections.abc import Sequence

from core.report.page.markup import Html, tag, together
from core.report.page.svg import Frame, picture, span
from core.report.page.words import Document, coordinate, percent

_WIDE, _HIGH = 900.0, 320.0
_SIDES = ((0.0, "both"), (-1.0, "backward"), (1.0, "forward"))
_IN_95 = 1.96
_ROW = 30.0


def finding_figure(curve: Document, unit: str) -> Html:
    """Show the mean residual over the coordinate that explains it: without the finding, then with it.

    The curve on the left is what the finding takes away, so that dots on it are explained.
    """
    joint, name = int(curve["joint"]), coordinate(curve["coordinate"], int(curve["joint"]))
    taken = [before - after for before, after in zip(curve["before"], curve["after"], strict=True)]
    reach = [_IN_95 * error for error in curve["standard_error"]]
    high = [value + room for value, room in zip(taken, reach, strict=True)]
    low = [value - room for value, room in zip(taken, reach, strict=True)]
    x, y = span(curve["centre"], margin=0.03), span(curve["before"], curve["after"], high, low)
    frames = [Frame(side * _WIDE / 2.0, 0.0, _WIDE / 2.0, _HIGH, x, y) for side in (0, 1)]
    labels = (f"{name}, {curve['unit']}", f"mean residual, {unit}")
    parts = [
        frames[0].axes("without it", *labels),
        frames[1].axes("with it in the model", *labels),
        *(frame.zero() for frame in frames),
    ]
    for rows, kind in _sides(curve):
        at, room = _taken(curve["centre"], rows), _taken(reach, rows)
        parts += [
            frames[0].band(at, _taken(low, rows), _taken(high, rows), "model"),
            frames[1].band(at, [-one for one in room], room, "floor"),
            frames[0].line(at, _taken(taken, rows), "model"),
            frames[0].dots(at, _taken(curve["before"], rows), kind),
            frames[1].dots(at, _taken(curve["after"], rows), kind),
        ]
    told = f"Measured minus predicted torque of joint {joint} over the {name}, without and with the finding."
    drawn = picture(f"Joint {joint}: residual over the {name}", told, (_WIDE, _HIGH), *parts)
    return tag("figure", drawn, tag("figcaption", _caption(curve)))


def dependence_figure(dependence: Document, unit: str) -> Html:
    """Show what is left of one joint's residual over one coordinate, with 95 % bars as a band about zero."""
    joint, name = int(dependence["joint"]), coordinate(dependence["coordinate"], int(dependence["joint"]))
    at, mean = dependence["centre"], dependence["mean"]
    room = [_IN_95 * error for error in dependence["standard_error"]]
    below = [-one for one in room]
    frame = Frame(0.0, 0.0, _WIDE, _HIGH, span(at, margin=0.03), span(mean, room, below))
    parts = (
        frame.axes(f"joint {joint}: what is left", f"{name}, {dependence['unit']}", f"mean residual, {unit}"),
        frame.band(at, below, room, "floor"),
        frame.zero(),
        frame.dots(at, mean, "both"),
    )
    title = f"Joint {joint}: what is left over the {name}"
    told = f"Mean residual of joint {joint} over the {name}, with all findings in the model."
    note = "Dots: means of equally many samples. Shaded: where 95 of 100 such means of noise alone would lie."
    return tag("figure", picture(title, told, (_WIDE, _HIGH), *parts), tag("figcaption", note))


def joint_bars(title: str, before: Sequence[float], after: Sequence[float], label: str) -> Html:
    """Compare one percentage per joint before and after as bars."""
    top, height = 34.0, 34.0 + _ROW * len(before) + 4.0
    scale = (_WIDE - 260.0) / max([*before, *after, 1e-9])
    rows = [
        _bar_pair(place, top + _ROW * place, (old * scale, new * scale), (old, new))
        for place, (old, new) in enumerate(zip(before, after, strict=True))
    ]
    head = tag("text", label, x=0, y=16, class_="title")
    told = "; ".join(
        f"joint {place + 1}: {percent(old)} before, {percent(new)} after"
        for place, (old, new) in enumerate(zip(before, after, strict=True))
    )
    return tag("figure", picture(title, told, (_WIDE, height), head, *rows))


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
        "Filled dots: forward motion; open dots: backward motion."
        if apart
        else "Dots: means of equally many samples."
    )
    return (
        f"{dots} Curve: what the finding adds that the other parameters cannot take up; dots that lie on it "
        "are explained. Shaded: where 95 of 100 such means would lie."
    )
