"""Say which rows and channels are left out because values are missing, and where too many are.

The equations of motion need every joint's position, so that a row without one of them serves no joint. Where
rows are missing the stamps show it: what is interpolated over, split or not used is decided by them.
"""

from collections.abc import Collection

import numpy as np

from ...arrays import Samples
from ...errors import LogError
from ..channels import CHANNELS, EFFORTS, TIME
from ..columns.layout import Layout
from ..defects.runs import Runs
from ..defects.stretch import count_text
from ..model import Defect, LogSource
from .ends import FEWEST_ROWS
from .survey import BLOCK_ROWS, Column, Survey

MOST_OF_ALL = 0.5
"""Up to this share of the rows between the first and the last whole one is left out: beyond it a channel was
not recorded at the log's rate, or not at all, and the user has to say which."""
MOST_FOR_A_SIDE = 0.1
"""A channel that a log may lack costs up to this share of the rows; beyond it the channel is left out."""
SHOWN_COLUMNS = 6
WHAT = "missing, not finite or beyond any size"


def scarce_channels(found: Survey, layout: Layout) -> tuple[str, ...]:
    """Name the channels without which a log does better: those that it may lack, with too few values.

    References that nobody asked for cost no row at all.
    """
    there = {bound.name for bound in layout.channels}
    return tuple(
        name
        for name, count in found.by_channel.items()
        if name in layout.default_references
        or (_may_lack(name, there) and count > MOST_FOR_A_SIDE * found.samples)
    )


def _may_lack(name: str, there: Collection[str]) -> bool:
    return name != TIME and (
        CHANNELS[name].need == "optional" or (name == EFFORTS[-1] and set(EFFORTS) <= set(there))
    )


def check_missing(found: Survey, layout: Layout) -> None:
    """Refuse a log most of whose rows lack a value, or which has too few that do not.

    Raises
    ------
    LogError
        With the columns and their first rows.
    """
    lacking, rows = found.inside
    if lacking <= MOST_OF_ALL * rows and found.samples - len(found.rows) >= FEWEST_ROWS:
        return
    columns = {_column(layout, column): column for column in found.worst}
    worst = next(iter(columns))
    count, first = found.counts[columns[worst]], found.first_rows[columns[worst]][0]
    raise LogError(
        f"the column {worst!r} holds {count_text(count, 'value')} {WHAT}, the first in row {first}; "
        f"{len(found.rows)} of {found.samples} rows lack a value",
        evidence={
            "columns": {
                name: {"rows": found.counts[column], "first_rows": found.first_rows[column]}
                for name, column in columns.items()
            },
            "rows": found.samples,
            "rows_that_lack_a_value": len(found.rows),
            "accepted_share": MOST_OF_ALL,
        },
        remedy=_remedy(columns[worst][0], layout),
    )


def _remedy(channel: str, layout: Layout) -> str:
    """Say what helps where the values of a channel are missing in most rows."""
    names = {bound.name for bound in layout.channels}
    if channel != TIME and (CHANNELS[channel].need == "reference" or _may_lack(channel, names)):
        return f'leave the channel out with "{channel}": null in the mapping'
    slower = (
        "where channels were recorded at instants of their own, bring them to those of the positions: "
        "veritorque logs join THIS -o run.parquet"
    )
    if channel not in EFFORTS:
        return slower
    other = next((name for name in EFFORTS if name != channel and name in names), None)
    instead = f'; "{channel}": null in the mapping takes {other} instead' if other else ""
    return (
        f"{slower}; where the {channel} of a joint was not measured at all, write 0 in its whole column: its "
        f"equations alone are then not used{instead}"
    )


def missing_defects(
    found: Survey, layout: Layout, source: LogSource
) -> tuple[tuple[Defect, ...], list[tuple[int, Samples]]]:
    """Describe the rows left out in the middle; give those of either end by their number and their stamps."""
    head, tail = found.ends
    samples = found.samples
    at_ends = [
        (stop - start, source.rows(start, stop).time)
        for start, stop in ((0, head), (samples - tail, samples))
        if stop > start
    ]
    if not (lacking := found.inside[0]):
        return (), at_ends
    runs = _runs(found, source, head, tail)
    joints = {joint for name, joint in found.counts if name != TIME}
    worst = found.worst
    shown = [
        f"{_column(layout, column)!r} in {count_text(found.counts[column], 'row')} from row "
        f"{found.first_rows[column][0]} on"
        for column in worst[:SHOWN_COLUMNS]
    ]
    more = len(worst) - SHOWN_COLUMNS
    statement = (
        f"{lacking} of {samples} rows ({100.0 * lacking / samples:.2g} %) lack a value ({WHAT}) "
        f"and are left out for all joints: {', '.join(shown)}"
        + (f" and {count_text(more, 'more column')}" if more > 0 else "")
        + "."
    )
    joint = joints.pop() + 1 if len(joints) == 1 else None
    return (Defect("missing_values", worst[0][0], joint, lacking, runs.intervals, statement),), at_ends


def scarce_defect(found: Survey, layout: Layout, channel: str) -> Defect:
    """Say that a channel is left out, because most of its values are missing."""
    count = found.by_channel[channel]
    bound = next(bound for bound in layout.channels if bound.name == channel)
    shown = ", ".join(map(repr, bound.columns[:SHOWN_COLUMNS]))
    statement = (
        f"{count} of {found.samples} rows ({100.0 * count / found.samples:.3g} %) lack a {channel}: the "
        f"channel is left out and {shown} ignored. Where it was recorded at a lower rate: "
        "veritorque logs join THIS -o run.parquet."
    )
    return Defect("missing_values", channel, None, count, (), statement)


def _runs(found: Survey, source: LogSource, head: int, tail: int) -> Runs:
    """Collect where rows in the middle are missing, by their own stamps or the last ones known."""
    runs, last = Runs(), np.nan
    marks = found.marks if found.marks is not None else np.zeros(source.samples, dtype=bool)
    stop = source.samples - tail
    for start in range(head, stop, BLOCK_ROWS):
        stamps = _filled(source.rows(start, min(start + BLOCK_ROWS, stop)).time, last)
        last = float(stamps[-1])
        runs.feed(marks[start : start + len(stamps)], stamps)
    runs.close()
    return runs


def _filled(stamps: Samples, last: float) -> Samples:
    """Put the last known stamp where one is missing."""
    known = np.isfinite(stamps)
    if known.all():
        return stamps
    at = np.maximum.accumulate(np.where(known, np.arange(len(stamps)), -1))
    return np.where(at >= 0, stamps[np.maximum(at, 0)], last)


def _column(layout: Layout, column: Column) -> str:
    name, joint = column
    if name == TIME:
        return layout.time.columns[0] if layout.time else TIME
    return next(bound for bound in layout.channels if bound.name == name).columns[joint]
