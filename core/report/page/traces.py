"""Draw measured and modelled signals over time: the exciting motion, and the torque per joint.

Traces come decimated, as lists with None at gaps.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from markupsafe import Markup

from .render import render
from .svg import Frame, picture, span
from .words import number, series

Trace = Sequence[float | None]
MOTION = ("position", "velocity")
MEASURED, FILTERED, ESTIMATED = "torque_measured", "torque_filtered", "torque_estimated"
PLAIN = (ESTIMATED, "residual")
EXTENDED = ("torque_estimated_after", "residual_after")
"""Estimate and residual of the model; after a diagnosis those of the extended model."""
_WIDE, _HIGH, _MOTION_HIGH = 900.0, 168.0, 220.0
_TOGETHER = 8
"""Joints whose motion shares a picture: the number of colours."""


@dataclass(frozen=True)
class JointTraces:
    """Hold the decimated traces of one joint in one log."""

    log: int
    joint: int
    """Numbers of the log and of the joint, counted from 1."""
    time: Sequence[float]
    """S."""
    signals: Mapping[str, Trace]
    """Named as in the file of traces, each as long as `time`."""
    units: Mapping[str, str]
    """Of the signals, by name."""
    held_out: Sequence[tuple[float, float]] = ()
    """Held-out spans of time, s."""


def traces_section(traces: Sequence[JointTraces], names: Sequence[str]) -> Markup:
    """Draw motion and torque of every log, of which `names` are given; empty without traces."""
    logs = [
        _log(number, [trace for trace in traces if trace.log == number], names)
        for number in sorted({trace.log for trace in traces})
    ]
    return render("traces.html.j2", {"logs": logs})


def _log(number: int, own: Sequence[JointTraces], names: Sequence[str]) -> dict[str, object]:
    groups = [own[begin : begin + _TOGETHER] for begin in range(0, len(own), _TOGETHER)]
    return {
        "number": number,
        "name": names[number - 1] if number <= len(names) else "",
        "motions": [
            {"pictures": _motion(group), "joints": [trace.joint for trace in group]} for group in groups
        ],
        "extended": EXTENDED[0] in own[0].signals,
        "torques": [_torque(trace) for trace in own],
    }


def _motion(joints: Sequence[JointTraces]) -> Markup:
    """Draw positions and velocities of several joints over one time axis."""
    return Markup("").join(_overlay(joints, signal) for signal in MOTION if signal in joints[0].signals)


def _range_sentence(trace: JointTraces, signal: str) -> str:
    low, high = _range(trace.signals[signal])
    return f"Joint {trace.joint} from {number(low)} to {number(high)} {trace.units[signal]}."


def _overlay(joints: Sequence[JointTraces], signal: str) -> Markup:
    unit = series(list(dict.fromkeys(trace.units[signal] for trace in joints)))
    values = [value for trace in joints for value in trace.signals[signal] if value is not None]
    frame = Frame(0.0, 0.0, _WIDE, _MOTION_HIGH, _time_range(joints), span(values))
    lines = [
        line
        for number, trace in enumerate(joints, start=1)
        for line in _lines(frame, trace.time, trace.signals[signal], f"j{number}")
    ]
    ranges = " ".join(_range_sentence(trace, signal) for trace in joints)
    text = f"{signal.capitalize()} of joints {joints[0].joint} to {joints[-1].joint} over time. {ranges}"
    title = f"{signal.capitalize()} of every joint"
    parts = (frame.axes(title, "time, s", unit), *lines)
    return picture(f"{title} over time", text, (_WIDE, _MOTION_HIGH), *parts)


def _torque(trace: JointTraces) -> Markup:
    """Draw a joint's torque: measured, filtered, estimated; held-out spans are shaded."""
    estimated, residual = EXTENDED if EXTENDED[0] in trace.signals else PLAIN
    shown = {MEASURED: "measured", FILTERED: "filtered", estimated: "estimated", residual: "residual"}
    values = [value for name in shown for value in trace.signals[name] if value is not None]
    frame = Frame(0.0, 0.0, _WIDE, _HIGH, _time_range([trace]), span(values))
    unit = trace.units[MEASURED]
    spans = [frame.band(ends, (frame.y[0],) * 2, (frame.y[1],) * 2, "held-out") for ends in trace.held_out]
    lines = [
        line for name, kind in shown.items() for line in _lines(frame, trace.time, trace.signals[name], kind)
    ]
    low, high = _range(trace.signals[MEASURED])
    title = f"Joint {trace.joint}"
    text = (
        f"Torque of joint {trace.joint} over time: measured, filtered, estimated by the model, and the "
        f"residual. The measured torque lies between {number(low)} and {number(high)} {unit}."
    )
    parts = (*spans, frame.axes(title, "time, s", f"torque, {unit}"), frame.zero(), *lines)
    return picture(f"{title}: torque over time", text, (_WIDE, _HIGH), *parts)


def _lines(frame: Frame, time: Sequence[float], values: Trace, kind: str) -> Iterator[Markup]:
    """Draw a trace, interrupted at gaps."""
    run: list[tuple[float, float]] = []
    for stamp, value in [*zip(time, values, strict=True), (0.0, None)]:
        if value is not None:
            run.append((stamp, value))
        elif run:
            yield frame.line([x for x, _ in run], [y for _, y in run], f"trace {kind}")
            run = []


def _time_range(joints: Sequence[JointTraces]) -> tuple[float, float]:
    stamps = [stamp for trace in joints for stamp in (trace.time[0], trace.time[-1])]
    return min(stamps), max(*stamps, min(stamps) + 1e-9)


def _range(values: Trace) -> tuple[float, float]:
    known = [value for value in values if value is not None]
    return (min(known), max(known)) if known else (0.0, 0.0)
