"""Draw what was measured and what the model says over time: the exciting motion, and the torque per joint.

Traces come thinned, as plain lists with None at gaps; a figure never holds a whole log.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from .markup import Html, section, tag
from .svg import Frame, picture, span
from .words import number, series

Trace = Sequence[float | None]

MOTION = ("position", "velocity")
MEASURED, FILTERED, ESTIMATED = "torque_measured", "torque_filtered", "torque_estimated"
PLAIN = (ESTIMATED, "residual")
EXTENDED = ("torque_estimated_after", "residual_after")
"""What the model says and what it leaves; after a diagnosis that of the extended model."""
_WIDE, _HIGH, _MOTION_HIGH = 900.0, 168.0, 220.0
_TOGETHER = 8
"""Joints whose motion shares a picture: as many as there are colours."""


@dataclass(frozen=True)
class JointTraces:
    """Carry the thinned traces of one joint in one log.

    Attributes
    ----------
    log, joint
        Counted from 1.
    time
        s.
    signals
        Named as in the file of traces, each as long as `time`.
    units
        Of the signals, by name.
    held_out
        Spans of time that no fit has seen, s.
    """

    log: int
    joint: int
    time: Sequence[float]
    signals: Mapping[str, Trace]
    units: Mapping[str, str]
    held_out: Sequence[tuple[float, float]] = ()


def traces_section(traces: Sequence[JointTraces], names: Sequence[str]) -> Html | None:
    """Show every log's motion and torque; None where nothing was kept.

    Parameters
    ----------
    names
        Of the logs.
    """
    if not traces:
        return None
    logs = sorted({one.log for one in traces})
    parts = [part for log in logs for part in _of_log(log, traces, names, headed=len(logs) > 1)]
    return section("What was measured, and what the model says", *parts, key="traces")


def _of_log(log: int, traces: Sequence[JointTraces], names: Sequence[str], *, headed: bool) -> Iterator[Html]:
    own = [one for one in traces if one.log == log]
    if headed:
        yield tag("h3", f"Log {log}: {names[log - 1] if log <= len(names) else ''}")
    for begin in range(0, len(own), _TOGETHER):
        yield _motion(own[begin : begin + _TOGETHER])
    yield _legend(own[0])
    yield from (_torque(one) for one in own)


def _motion(joints: Sequence[JointTraces]) -> Html:
    """Draw positions and speeds of several joints over one time axis."""
    panels = [_overlaid(joints, signal) for signal in MOTION if signal in joints[0].signals]
    marks = [
        tag("span", tag("i", class_=f"swatch j{place}"), f" joint {one.joint}")
        for place, one in enumerate(joints, start=1)
    ]
    told = tag("figcaption", "The exciting motion: positions, and speeds as differentiated. ", *marks)
    return tag("figure", *panels, told, class_="traces legend", tabindex=0)


def _overlaid(joints: Sequence[JointTraces], signal: str) -> Html:
    what = {"position": "Position", "velocity": "Speed"}[signal]
    unit = series(list(dict.fromkeys(one.units[signal] for one in joints)))
    values = [value for one in joints for value in one.signals[signal] if value is not None]
    frame = Frame(0.0, 0.0, _WIDE, _MOTION_HIGH, _ends(joints), span(values))
    lines = [
        line
        for place, one in enumerate(joints, start=1)
        for line in _lines(frame, one.time, one.signals[signal], f"j{place}")
    ]
    told = f"{what} of joints {joints[0].joint} to {joints[-1].joint} over time. " + " ".join(
        f"Joint {one.joint} from {number(low)} to {number(high)} {one.units[signal]}."
        for one in joints
        for low, high in [_reach(one.signals[signal])]
    )
    parts = (frame.axes(f"{what} of every joint", "time, s", unit), *lines)
    return picture(f"{what} of every joint over time", told, (_WIDE, _MOTION_HIGH), *parts)


def _torque(one: JointTraces) -> Html:
    """Draw a joint's torque: measured, filtered, estimated; spans that no fit has seen are shaded."""
    estimated, residual = EXTENDED if EXTENDED[0] in one.signals else PLAIN
    shown = {MEASURED: "measured", FILTERED: "filtered", estimated: "estimated", residual: "residual"}
    values = [value for name in shown for value in one.signals[name] if value is not None]
    frame = Frame(0.0, 0.0, _WIDE, _HIGH, _ends([one]), span(values))
    unit = one.units[MEASURED]
    unseen = [frame.band(ends, (frame.y[0],) * 2, (frame.y[1],) * 2, "unseen") for ends in one.held_out]
    lines = [
        line for name, kind in shown.items() for line in _lines(frame, one.time, one.signals[name], kind)
    ]
    low, high = _reach(one.signals[MEASURED])
    title = f"Joint {one.joint}"
    told = (
        f"Torque of joint {one.joint} over time: measured, filtered, estimated by the model, and the "
        f"difference of the last two. The measured one lies between {number(low)} and {number(high)} {unit}."
    )
    parts = (*unseen, frame.axes(title, "time, s", f"torque, {unit}"), frame.zero(), *lines)
    return tag(
        "figure",
        picture(f"{title}: torque over time", told, (_WIDE, _HIGH), *parts),
        class_="traces",
        tabindex=0,
    )


def _legend(one: JointTraces) -> Html:
    whose = "the extended model" if EXTENDED[0] in one.signals else "the identified model"
    words = {
        "measured": "measured",
        "filtered": "measured, through the parallel filter: what the model is fitted to",
        "estimated": f"estimated by {whose}, through the same filter",
        "residual": "what is left: filtered minus estimated",
        "unseen": "shaded: blocks that no fit has seen",
    }
    marks = [tag("span", tag("i", class_=f"swatch {kind}"), f" {told}") for kind, told in words.items()]
    return tag("p", tag("b", "Torque per joint. "), *marks, class_="note legend")


def _lines(frame: Frame, time: Sequence[float], values: Trace, kind: str) -> Iterator[Html]:
    """Draw a trace, broken where it has gaps."""
    run: list[tuple[float, float]] = []
    for stamp, value in [*zip(time, values, strict=True), (0.0, None)]:
        if value is not None:
            run.append((stamp, value))
        elif run:
            yield frame.line([x for x, _ in run], [y for _, y in run], f"trace {kind}")
            run = []


def _ends(joints: Sequence[JointTraces]) -> tuple[float, float]:
    stamps = [stamp for one in joints for stamp in (one.time[0], one.time[-1])]
    return min(stamps), max(*stamps, min(stamps) + 1e-9)


def _reach(values: Trace) -> tuple[float, float]:
    there = [value for value in values if value is not None]
    return (min(there), max(there)) if there else (0.0, 0.0)
