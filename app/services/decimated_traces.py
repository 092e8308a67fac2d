"""Answer with what a job computed instant by instant, thinned for a screen."""

import math
from dataclasses import asdict
from typing import Annotated

import numpy as np
from fastapi import Depends, Query, Response

from ...core.log.preview import FEWEST_POINTS, MOST_POINTS
from ...core.report.traces.layout import SIGNALS
from ...core.report.traces.reading import Traces, View, read_traces
from ...core.report.traces.views import read_views
from ..http.immutable_response import Blob
from ..inspection.log_reading import ChannelSelection
from ..json_text import json_bytes
from ..problems import Problem

Number = Annotated[int, Query(ge=1, description="counted from 1")]
Stamp = Annotated[float | None, Query(allow_inf_nan=False, description="s, on the clock of the log")]
Channels = Annotated[
    str | None, Query(max_length=100, description="names, separated by commas; default: all")
]
Names = Annotated[str, Query(max_length=200, description="names, separated by commas")]
Points = Annotated[int, Query(ge=FEWEST_POINTS, le=MOST_POINTS, description="maximum points per trace")]


def _view(
    joint: Number,
    signals: Names = "torque_measured,torque_filtered,torque_estimated,residual",
    log: Number = 1,
    begin: Annotated[Stamp, Query(alias="from")] = None,
    end: Annotated[Stamp, Query(alias="to")] = None,
    points: Points = 2000,
) -> View:
    names = tuple(name.strip() for name in signals.split(","))
    if not set(names) <= set(SIGNALS) or len(set(names)) < len(names):
        raise Problem(
            "request",
            "the signals are not ones that a result has, each once",
            evidence={"parameter": "signals", "given": list(names), "known": list(SIGNALS)},
            remedy="name known signals with commas between them",
        )
    return View(log, joint, names, begin, end, points)


ViewOf = Annotated[View, Depends(_view)]
"""What is asked for in a query."""


def _selection(
    points: Points = 2000,
    channels: Channels = None,
    begin: Annotated[Stamp, Query(alias="from")] = None,
    end: Annotated[Stamp, Query(alias="to")] = None,
) -> ChannelSelection:
    names = () if channels is None else tuple(name.strip() for name in channels.split(","))
    return ChannelSelection(names, points, begin, end)


SelectionOf = Annotated[ChannelSelection, Depends(_selection)]
"""What of a log is asked for in a query."""


def traces_response(traces: Blob, view: View, if_none_match: str | None) -> Response:
    """Draw traces.

    Raises
    ------
    OptionError
        If the result has no such log, joint or signal, or nothing was measured in that stretch of time.
    """
    asked = (view.log, view.joint, "+".join(view.signals), view.begin, view.end, view.points)
    form = "-".join(map(str, asked))

    def drawn() -> Response:
        traces.check()
        with traces.local_copy() as file:
            document = _document(view, read_traces(file, view))
        return Response(json_bytes(document), media_type="application/json")

    return traces.respond(if_none_match, form, drawn)


def views_response(traces: Blob, *, log: int, joint: int, if_none_match: str | None) -> Response:
    """Draw what is left over position, velocity and frequency.

    Raises
    ------
    OptionError
        If the result has no such log or joint.
    ExcitationError
        If too few instants count.
    """

    def drawn() -> Response:
        traces.check()
        with traces.local_copy() as file:
            document = {"log": log, "joint": joint} | asdict(read_views(file, log=log, joint=joint))
        return Response(json_bytes(_lists(document)), media_type="application/json")

    return traces.respond(if_none_match, f"views-{log}-{joint}", drawn)


def _lists(value: object) -> object:
    """Write arrays as lists of numbers with the digits that single precision has."""
    if isinstance(value, dict):
        return {name: _lists(entry) for name, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_lists(entry) for entry in value]
    return _round(value.tolist()) if isinstance(value, np.ndarray) else value


def _document(view: View, traces: Traces) -> dict[str, object]:
    return {
        "log": view.log,
        "joint": view.joint,
        "extent": traces.extent,
        "rows_per_stretch": traces.rows_per_stretch,
        "time": {"unit": "s", "values": [round(stamp, 6) for stamp in traces.time.tolist()]},
        "traces": [
            {"signal": signal, "joint": view.joint, "unit": unit, "values": _round(values.tolist())}
            for signal, unit, values in zip(view.signals, traces.units, traces.values.T, strict=True)
        ],
        "held_out": traces.held_out,
        "left_out": traces.left_out,
    }


def _round(values: list[float]) -> list[float | None]:
    """Write numbers with the digits that single precision has; None at gaps."""
    return [float(f"{value:.7g}") if math.isfinite(value) else None for value in values]
