"""Draw the report of a result document with the traces that were kept beside it."""

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ...core.log.preview import FEWEST_POINTS
from ...core.report.page.page import compose_page
from ...core.report.page.running import Origin
from ...core.report.page.traces import EXTENDED, FILTERED, MEASURED, MOTION, PLAIN, JointTraces
from ...core.report.traces.reading import Traces, View, read_traces

POINTS_TOGETHER = 4000
"""Points of all joints of a page together, so that a robot of many joints makes no page of many megabytes."""


def report_page(document: dict[str, Any], traces: Path | None, origin: Origin | None = None) -> str:
    """Write the report of a result; without traces it lacks the figures over time."""
    drawn = [] if traces is None else [*_traces(document, traces)]
    return compose_page(document, origin=origin, traces=drawn)


def _traces(document: dict[str, Any], kept: Path) -> Iterator[JointTraces]:
    extended = bool(document.get("diagnosis") and document["diagnosis"]["after"].get("base_parameters"))
    signals = (*MOTION, MEASURED, FILTERED, *(EXTENDED if extended else PLAIN))
    logs, joints = len(document["logs"]), len(document["fit"])
    points = max(POINTS_TOGETHER // (logs * joints), FEWEST_POINTS)
    for log in range(1, logs + 1):
        for joint in range(1, joints + 1):
            view = View(log, joint, signals, points=points)
            yield _drawable(view, read_traces(kept, view))


def _drawable(view: View, traces: Traces) -> JointTraces:
    columns = zip(view.signals, traces.values.T.tolist(), strict=True)
    return JointTraces(
        log=view.log,
        joint=view.joint,
        time=traces.time.tolist(),
        signals={
            name: [value if math.isfinite(value) else None for value in column] for name, column in columns
        },
        units=dict(zip(view.signals, traces.units, strict=True)),
        held_out=traces.held_out,
    )
